//! Prints the C header: `cargo run -q > ../include/hitscan.h`.

use std::error::Error;

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

fn main() -> Result<(), Box<dyn Error>> {
    let config = cbindgen::Config::from_file(format!("{FOLDER}/cbindgen.toml"))?;
    let mut header = Vec::new();
    cbindgen::generate_with_config(format!("{FOLDER}/.."), config)?.write(&mut header);
    print!("{}", plain(&String::from_utf8(header)?));
    Ok(())
}

/// Pointers as pointers, where the sources have a type for each (`typedef const float *hitscan_In_f32;`), and names of values
/// without the names of their types.
fn plain(header: &str) -> String {
    let mut pointers = Vec::new();
    let mut blocks = Vec::new();
    for block in header.split("\n\n") {
        let typedef = block.lines().last().and_then(|line| line.strip_prefix("typedef ")?.strip_suffix(';'));
        match typedef.and_then(|typedef| typedef.split_once('*')) {
            Some(pointer) => pointers.push(pointer),
            None => blocks.push(block),
        }
    }
    let mut header = blocks.join("\n\n");
    for (target, name) in pointers {
        header = header.replace(&format!("{name} "), &format!("{target}*"));
    }
    for kind in ["STATUS", "STRUCTURE", "PRESET"] {
        header = header.replace(&format!("HITSCAN_{kind}_"), "HITSCAN_");
    }
    header
}
