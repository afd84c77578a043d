use std::process::{Command, Output};

fn run(arguments: &[&str], without_driver: bool) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hitscan-gpu"));
    if without_driver {
        command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
    }
    command.args(arguments).output().unwrap()
}

#[test]
fn failures_are_said_and_end_with_2() {
    let missing = run(&["cast", "/nowhere.hits", "/nowhere.rays", "-o", "/nowhere"], false);
    assert_eq!(missing.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&missing.stderr).contains("/nowhere"));
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_gpu_the_program_says_so_and_ends_with_2() {
    let none = run(&["adapters"], true);
    assert_eq!(none.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&none.stderr).contains("no GPU: install a driver"));
}

#[test]
fn a_gpu_that_is_not_there_is_not_opened() {
    if crate::scene::device().is_none() {
        return;
    }
    let error = hitscan_gpu::Device::open(Some("abacus")).unwrap_err().to_string();
    assert!(error.contains("abacus") && error.contains("name one of"), "{error}");
}
