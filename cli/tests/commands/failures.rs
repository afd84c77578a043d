//! Bad inputs and outputs: one line, code 2, and no half file, for every subcommand.

use std::process::{Output, Stdio};

use crate::folder::{Folder, TETRAHEDRON};

/// Each subcommand at work on the model `{}`.
const READERS: [&str; 5] = [
    "render {} --size 8x8 --samples 1 -o out.png",
    "bake {} -o out.hits",
    "info {}",
    "cast {} one.rays -o out.bin",
    "compare {} -n 100 --rounds 1",
];

/// A folder with one ray, too.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write_rays("one.rays", &[[0.2, 0.2, 5.0, 0.0, 0.0, -1.0_f32]]);
    folder
}

/// Every subcommand must refuse `model` in a line that contains `part`.
fn refused(folder: &Folder, model: &str, part: &str) {
    for reader in READERS {
        let error = folder.refuse(&reader.replace("{}", model));
        assert!(error.contains(part), "{reader}: {error}");
    }
}

#[test]
fn what_is_missing_or_no_mesh_is_named() {
    let folder = folder();
    refused(&folder, "missing.obj", "missing.obj: no such file");
    refused(&folder, "missing.hits", "missing.hits: no such file");
    refused(&folder, ".", "is a directory");
    folder.write("empty.obj", "");
    refused(&folder, "empty.obj", "is empty");
    folder.write("diary.txt", "Dear diary, no mesh today.");
    refused(&folder, "diary.txt", "neither a mesh nor an asset: use a file ending in .obj");
    for name in ["garbage.obj", "garbage.stl", "garbage.ply", "garbage.glb", "garbage.obj.gz", "garbage.hits"] {
        folder.write(name, [0xa7_u8, 0, 255, 13].repeat(99));
        refused(&folder, name, name);
    }
}

#[test]
fn bad_triangles_are_named() {
    let folder = folder();
    folder.write("index.obj", TETRAHEDRON.replace("f 2 3 4", "f 2 3 5"));
    refused(&folder, "index.obj", "index.obj:8: triangle 3 names vertex 5");
    folder.write("nan.obj", TETRAHEDRON.replace("v 0 1 0", "v 0 nan 0"));
    refused(&folder, "nan.obj", "nan.obj:3: vertex 2");
    folder.write("huge.obj", TETRAHEDRON.replace("v 0 1 0", "v 0 3e38 0"));
    refused(&folder, "huge.obj", "huge.obj: vertex 2 of triangle 0");
    folder.write("points.obj", "v 0 0 0\nv 1 0 0\n");
    refused(&folder, "points.obj", "no triangles");
}

#[test]
fn damaged_assets_are_refused_everywhere() {
    let folder = folder();
    folder.succeed("bake tetrahedron.obj -o whole.hits");
    let whole = folder.read("whole.hits");
    for end in (0..whole.len()).step_by(3) {
        folder.write("short.hits", &whole[..end]);
        assert!(folder.refuse("info short.hits").contains("short.hits"));
    }
    for (name, place) in [("header.hits", 9), ("table.hits", 30), ("contents.hits", whole.len() - 1)] {
        let mut bytes = whole.clone();
        bytes[place] ^= 0x40;
        folder.write(name, bytes);
        for reader in ["render {}", "info {}", "cast {} one.rays -o out.bin"] {
            folder.refuse(&reader.replace("{}", name));
        }
    }
    assert!(folder.refuse("bake whole.hits -o again.hits").contains("is an asset already"));
}

#[test]
fn bad_rays_and_hits_are_refused() {
    let folder = folder();
    folder.write("ragged.rays", [0; 50]);
    assert!(folder.refuse("cast tetrahedron.obj ragged.rays -o out.bin").contains("not a whole number of rays"));
    assert!(folder.refuse("cast tetrahedron.obj one.rays -o out.bin --interval").contains("rays of 32 bytes"));
    folder.refuse("cast tetrahedron.obj missing.rays -o out.bin");
    folder.refuse("cast tetrahedron.obj . -o out.bin");
    folder.write("ragged.bin", [0; 9]);
    folder.write("good.bin", [0; 8]);
    for pair in ["ragged.bin good.bin", "good.bin ragged.bin", "good.bin missing.bin", ". good.bin"] {
        folder.refuse(&format!("diff {pair}"));
    }
}

#[test]
fn outputs_that_cannot_be_written_are_refused() {
    let folder = folder();
    for target in ["no/such/folder/out", "."] {
        for writer in ["render --size 8x8 --samples 1", "bake tetrahedron.obj", "cast tetrahedron.obj one.rays"] {
            folder.refuse(&format!("{writer} -o {target}"));
        }
    }
}

#[test]
fn an_output_replaces_no_input() {
    let folder = folder();
    folder.succeed("bake tetrahedron.obj -o keep.hits");
    folder.succeed("render tetrahedron.obj --size 8x8 --samples 1 --tiles 0 --of 1 -o part.png");
    for (arguments, kept) in [
        ("cast keep.hits one.rays -o keep.hits", "keep.hits"),
        ("cast keep.hits one.rays -o ./one.rays", "one.rays"),
        ("render keep.hits -o keep.hits", "keep.hits"),
        ("bake tetrahedron.obj -o tetrahedron.obj", "tetrahedron.obj"),
        ("merge part.png -o part.png", "part.png"),
        ("compare tetrahedron.obj --csv tetrahedron.obj", "tetrahedron.obj"),
        ("compare tetrahedron.obj --rays one.rays --plot one.rays", "one.rays"),
    ] {
        let before = folder.read(kept);
        let error = folder.refuse(arguments);
        assert!(error.contains(&format!("{kept}: is read and written: give another -")), "{error}");
        assert!(folder.read(kept) == before, "{arguments}");
    }
    // Standard streams and devices are both without harm.
    #[cfg(target_os = "linux")]
    folder.succeed("cast tetrahedron.obj /dev/null -o /dev/null");
}

#[test]
fn answers_are_not_taken_for_an_asset() {
    let folder = folder();
    folder.succeed("cast tetrahedron.obj one.rays -o answers.hits");
    for reader in ["info {}", "render {} -o out.png", "cast {} one.rays -o out.bin", "compare {}"] {
        let error = folder.refuse(&reader.replace("{}", "answers.hits"));
        assert!(
            error.contains("answers.hits: is no asset, but may be answers of `hitscan cast`: name what"),
            "{error}"
        );
    }
    for name in ["cast", "diff"] {
        let text = folder.succeed(&format!("{name} --help"));
        assert!(text.contains(".answers") && !text.contains(".hits"), "{text}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported() {
    let folder = folder();
    let writers = ["render --size 8x8 --samples 1", "bake tetrahedron.obj", "cast tetrahedron.obj one.rays"];
    for writer in writers {
        let output = folder.run(&format!("{writer} -o /dev/full"));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{writer}: {errors}");
        assert!(
            errors.ends_with("hitscan: /dev/full: the disk is full: free some space or choose another disk\n"),
            "{errors}"
        );
    }
    folder.write("good.bin", [0; 8]);
    let printers = [
        "info tetrahedron.obj",
        "diff good.bin good.bin",
        "render --size 8x8 --samples 1 --preview",
        "bake tetrahedron.obj",
    ];
    for printer in printers {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let output = folder.command(printer).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{printer}");
        assert!(String::from_utf8(output.stderr).unwrap().contains("the disk is full"), "{printer}");
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let folder = folder();
    folder.write_rays("many.rays", &[[0.2, 0.2, 5.0, 0.0, 0.0, -1.0_f32]; 50_000]);
    for arguments in ["cast tetrahedron.obj many.rays --csv", "cast tetrahedron.obj many.rays", "render --help"] {
        let mut child = folder.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{arguments}");
        assert!(!String::from_utf8(output.stderr).unwrap().contains("hitscan: "), "{arguments}");
    }
}

#[test]
fn the_command_line_itself_is_checked() {
    let folder = folder();
    for arguments in [
        "paint",
        "render --colour red",
        "cast",
        "cast tetrahedron.obj",
        "diff one",
        "bake",
        "info a b",
        "bake a --fit 64Q",
        "compare a --growth=1k",
    ] {
        assert!(folder.refuse(arguments).contains("--help"), "{arguments}");
    }
    let error = folder.refuse("render --bounces -1");
    assert!(error.contains("unexpected argument '-1' found: see") && !error.contains("tip"), "{error}");
    for (option, range) in [("--bounces 1000000", "0..=16"), ("--samples 1000000", "1..=16")] {
        assert!(folder.refuse(&format!("render {option}")).contains(range), "{option}");
    }
    for (name, value) in [("render", "[MODEL|ASSET|WORLD]"), ("cast", "<MODEL|ASSET|WORLD>"), ("bake", "<MODEL|WORLD>")]
    {
        let text = folder.succeed(&format!("{name} --help"));
        assert!(text.contains(&format!("hitscan {name} [OPTIONS] {value}")) && text.contains("(.toml)"), "{text}");
    }
    assert!(!folder.succeed("info --help").contains("wide") && folder.succeed("cast --help").contains("or wide"));
    for name in ["", "render ", "bake ", "info ", "cast ", "compare ", "diff "] {
        let text = folder.succeed(&format!("{name}--help"));
        assert!(text.contains("Usage: hitscan"), "{text}");
        assert!(text.contains("Example") || name.is_empty(), "{text}");
    }
    assert_eq!(folder.run("").status.code(), Some(2));
}

/// What nobody can read, not even its owner.
#[cfg(target_os = "linux")]
#[test]
fn unreadable_files_are_refused() {
    let folder = folder();
    refused(&folder, "/proc/self/mem", "/proc/self/mem");
    folder.write("good.bin", [0; 8]);
    for arguments in [
        "cast tetrahedron.obj /proc/self/mem -o out.bin",
        "compare tetrahedron.obj --rays /proc/self/mem",
        "diff /proc/self/mem good.bin",
        "diff good.bin /proc/self/mem",
    ] {
        assert!(folder.refuse(arguments).contains("/proc/self/mem"), "{arguments}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn figures_for_a_full_disk_are_refused() {
    let folder = folder();
    for option in ["--csv", "--plot"] {
        let output = folder.run(&format!("compare tetrahedron.obj -n 100 --rounds 1 {option} /dev/full"));
        assert_eq!(output.status.code(), Some(2), "{option}");
        assert!(String::from_utf8(output.stderr).unwrap().ends_with("free some space or choose another disk\n"));
    }
}

/// Every subcommand at work, with something to print.
const PRINTERS: [&str; 6] = [
    "render --size 8x8 --samples 1 --preview -o out.png",
    "bake tetrahedron.obj -o out.hits",
    "info tetrahedron.obj",
    "cast tetrahedron.obj one.rays --csv",
    "compare tetrahedron.obj -n 100 --rounds 1",
    "diff good.bin good.bin",
];

#[test]
fn nobody_who_listens_is_no_reason_to_panic() {
    let folder = folder();
    folder.write("good.bin", [0; 8]);
    for printer in PRINTERS {
        let mut child = folder.command(printer).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(0), "{printer}");
    }
    for reader in READERS {
        let mut child = folder.command(&reader.replace("{}", "missing.obj")).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(2), "{reader}");
    }
}

/// Starts the program with signals as this option of `env` has them, whatever they are here; it is sent `signal` so much later.
#[cfg(target_os = "linux")]
fn disturbed(folder: &Folder, option: &str, arguments: &str, (signal, milliseconds): (&str, u64)) -> Output {
    use std::{process::Command, thread::sleep, time::Duration};
    let program = folder.command(arguments);
    let child = Command::new("env")
        .arg(option)
        .arg(program.get_program())
        .args(program.get_args())
        .current_dir(folder.path("."))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(milliseconds));
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    child.wait_with_output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn signals_that_were_turned_off_stay_so() {
    let folder = folder();
    let arguments = "render tetrahedron.obj --size 1600x1200 --samples 2 -o out.png";
    let output = disturbed(&folder, "--ignore-signal=HUP", arguments, ("-HUP", 200));
    assert!(output.status.success(), "{output:?}");
    assert!(folder.path("out.png").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_program_says_so_and_leaves_nothing() {
    use std::os::unix::process::ExitStatusExt;
    let folder = folder();
    folder.write_rays("many.rays", &[[0.2, 0.2, 5.0, 0.0, 0.0, -1.0_f32]; 400_000]);
    let before = folder.names();
    let long = [
        "render --size 4000x4000 --samples 16 -o out.png",
        "compare --growth=4M --csv out.csv",
        // Most of its time goes into writing.
        "cast tetrahedron.obj many.rays --csv -o out.csv",
    ];
    let mut interrupted = 0;
    for (arguments, milliseconds) in long.into_iter().flat_map(|a| [100, 200, 400].map(|time| (a, time))) {
        let output = disturbed(&folder, "--default-signal=INT,TERM,HUP", arguments, ("-INT", milliseconds));
        let errors = String::from_utf8(output.stderr).unwrap();
        // On a busy machine it may not have begun.
        if output.status.signal().is_some() {
            continue;
        }
        if arguments.starts_with("cast") && folder.path("out.csv").exists() {
            // It had finished, even if it had not ended yet.
            let said_last = match output.status.code() {
                Some(0) => " Mrays/s\n",
                Some(130) => "hitscan: interrupted: what was not finished is not written\n",
                code => panic!("{arguments}: {code:?} {errors}"),
            };
            assert!(errors.ends_with(said_last), "{arguments}: {errors}");
            let lines = folder.read("out.csv").iter().filter(|&&byte| byte == b'\n').count();
            assert_eq!(lines, 400_001, "{arguments}: {errors}");
            std::fs::remove_file(folder.path("out.csv")).unwrap();
            continue;
        }
        interrupted += 1;
        assert_eq!(output.status.code(), Some(130), "{arguments}: {errors}");
        assert_eq!(errors, "hitscan: interrupted: what was not finished is not written\n", "{arguments}");
        assert_eq!(folder.names(), before, "{arguments}");
    }
    assert!(interrupted >= 6, "{interrupted}");
}
