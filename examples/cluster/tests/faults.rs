//! What goes wrong in clusters, done for real on loopback: each time the answer is that of one machine, to the byte.
//!
//! Needs `nats-server`; without it the tests fail and say so.

mod cluster;

use std::{fs, thread::sleep, time::Duration};

use cluster::Cluster;

/// Enough tiles that something can happen between them.
const SETTINGS: &str = "--size 64x96 --samples 1";

#[test]
fn a_picture_is_that_of_one_machine() {
    let cluster = Cluster::new();
    let (_one, _two) = (cluster.worker(""), cluster.worker(""));
    cluster.submit(SETTINGS);
    cluster.compare(SETTINGS);
    // Finished jobs leave nothing behind.
    let status = cluster.run("status");
    assert!(status.contains("no jobs") && status.matches("worker ").count() == 2, "{status}");
}

#[test]
fn hits_are_those_of_one_machine() {
    let cluster = Cluster::new();
    let rays: Vec<u8> = (0..40_000_u32)
        .flat_map(|n| [(n % 200) as f32 * 0.01 - 0.5, (n / 200) as f32 * 0.01 - 0.5, 4.0, 0.0, 0.0, -1.0_f32])
        .flat_map(f32::to_le_bytes)
        .collect();
    fs::write(cluster.path("rays"), &rays).unwrap();
    let _worker = cluster.worker("");
    for query in ["closest", "any", "count"] {
        cluster.run(&format!("cast scene.hits rays -o shared --query {query}"));
        let alone = cluster.cast_alone(&rays, query);
        assert!(fs::read(cluster.path("shared")).unwrap() == alone, "{query}");
        assert!(alone.len() == 40_000 * 8 && alone.chunks(8).any(|hit| hit[4..] != [255; 4]));
    }
}

#[test]
fn a_worker_killed_in_a_tile_loses_nothing() {
    let cluster = Cluster::new();
    let id = cluster.detach(SETTINGS);
    let mut doomed = cluster.worker("--pause 400");
    cluster.wait_for(&id, 2);
    // Each tile takes it 400 ms, so it is in the middle of one.
    doomed.kill().unwrap();
    doomed.wait().unwrap();
    let _other = cluster.worker("");
    cluster.submit(SETTINGS);
    cluster.compare(SETTINGS);
}

#[test]
fn a_server_killed_and_restarted_loses_nothing() {
    let mut cluster = Cluster::new();
    let id = cluster.detach(SETTINGS);
    let _worker = cluster.worker("--pause 100");
    cluster.wait_for(&id, 3);
    let submit = cluster.start(&format!("submit scene.hits -o shared.png {SETTINGS}"));
    sleep(Duration::from_millis(500));
    cluster.stop_server();
    sleep(Duration::from_millis(700));
    cluster.start_server();
    let output = submit.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    cluster.compare(SETTINGS);
}

#[test]
fn a_tile_done_twice_counts_once() {
    let cluster = Cluster::new();
    let id = cluster.detach(SETTINGS);
    let sleeper = cluster.worker("--pause 400");
    cluster.wait_for(&id, 1);
    // It holds tiles without a sign of life for longer than the server waits, and finishes them afterwards.
    cluster::signal(&sleeper, "STOP");
    let _other = cluster.worker("--pause 50");
    sleep(Duration::from_secs(4));
    cluster::signal(&sleeper, "CONT");
    let all = cluster.wait_for(&id, 12);
    assert_eq!(all, 12);
    cluster.wait_until(|| cluster.run("status").contains("12 of 12 tiles (100 %), 0 to do"));
    // Time for the sleeper to finish what it held, and to tell.
    sleep(Duration::from_secs(3));
    assert_eq!(cluster.done_by_workers().iter().sum::<u32>(), 12);
    cluster.submit(SETTINGS);
    cluster.compare(SETTINGS);
}

#[test]
fn a_corrupt_asset_is_named_and_replaced() {
    let cluster = Cluster::new();
    let id = cluster.detach(SETTINGS);
    cluster.corrupt_asset();
    let _worker = cluster.worker("");
    cluster.wait_until(|| cluster.run("status").contains("is not what its hash says"));
    assert_eq!(cluster.wait_for(&id, 0), 0);
    // Given again, the job has its asset again.
    cluster.submit(SETTINGS);
    cluster.compare(SETTINGS);
}

#[test]
fn a_damaged_cache_is_fetched_again() {
    let cluster = Cluster::new();
    let mut first = cluster.worker("");
    cluster.submit(SETTINGS);
    first.kill().unwrap();
    first.wait().unwrap();
    for entry in fs::read_dir(cluster.path("cache")).unwrap() {
        let path = entry.unwrap().path();
        let mut bytes = fs::read(&path).unwrap();
        bytes[500] ^= 1;
        fs::write(&path, bytes).unwrap();
    }
    let _second = cluster.worker("");
    fs::remove_file(cluster.path("shared.png")).unwrap();
    cluster.submit(SETTINGS);
    cluster.compare(SETTINGS);
}

#[test]
fn a_worker_of_another_version_is_refused() {
    let cluster = Cluster::new();
    let id = cluster.detach(SETTINGS);
    let error = cluster.refuse("worker --pretend 0.0.9-ffffffff");
    assert!(error.contains("this is version 0.0.9-ffffffff, the jobs are for 0.1.0-"), "{error}");
    assert_eq!(cluster.wait_for(&id, 0), 0);
    // One that was there before the job gets nothing of it either.
    cluster.submit_with_worker(SETTINGS);
    let _stranger = cluster.worker("--pretend 0.0.9-ffffffff");
    let id = cluster.detach(SETTINGS);
    sleep(Duration::from_secs(2));
    assert_eq!(cluster.wait_for(&id, 0), 0);
    cluster.submit_with_worker(SETTINGS);
    cluster.compare(SETTINGS);
}

#[test]
fn a_slow_worker_keeps_its_tiles_and_holds_nobody_up() {
    let cluster = Cluster::new();
    let id = cluster.detach(SETTINGS);
    // Three seconds a tile, and the server would wait for two: it says that it lives.
    let _slow = cluster.worker("--pause 3000");
    sleep(Duration::from_secs(1));
    let _quick = cluster.worker("--pause 50");
    cluster.wait_for(&id, 10);
    let done = cluster.wait_for(&id, 12);
    assert_eq!(done, 12);
    // It has done something, and nobody has done it again.
    cluster.wait_until(|| {
        let done = cluster.done_by_workers();
        done.len() == 2 && done.iter().all(|tiles| *tiles > 0) && done.iter().sum::<u32>() == 12
    });
    cluster.submit(SETTINGS);
    cluster.compare(SETTINGS);
}

#[test]
fn strangers_are_not_let_in() {
    let mut cluster = Cluster::new();
    cluster.stop_server();
    cluster.start_server_with(&["--user", "me", "--pass", "sesame"]);
    fs::write(cluster.path("password"), "sesame\n").unwrap();
    fs::write(cluster.path("wrong"), "simsim\n").unwrap();
    assert!(cluster.refuse("status").contains("no connection"));
    assert!(cluster.refuse("status --user me --password-file wrong").contains("no connection"));
    assert!(cluster.run("status --user me --password-file password").contains("no jobs"));
}

#[test]
fn nonsense_is_refused_in_one_line() {
    let cluster = Cluster::new();
    fs::write(cluster.path("odd"), [0; 25]).unwrap();
    for (arguments, why) in [
        ("submit none.hits", "no such file"),
        ("submit mesh.obj", "is no asset"),
        ("cast scene.hits odd -o hits", "not whole rays"),
        ("status --server nats://127.0.0.1:1", "no connection"),
        ("serve --listen 0.0.0.0", "everybody on that network"),
        ("serve --nats-server /nowhere", "not found"),
    ] {
        let error = cluster.refuse(arguments);
        assert!(error.contains(why), "{arguments}: {error}");
    }
}
