//! Pictures in parts: put together they are the whole, and what does not belong together is refused.

use crate::folder::Folder;

const SETTINGS: &str = "--size 24x20 --samples 1";

/// A folder with a whole picture of the tetrahedron.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.succeed(&format!("render tetrahedron.obj {SETTINGS} -o whole.png"));
    folder
}

fn part(folder: &Folder, tiles: &str, of: u32, name: &str) -> String {
    folder.succeed(&format!("render tetrahedron.obj {SETTINGS} --tiles {tiles} --of {of} -o {name}"))
}

#[test]
fn parts_make_the_whole_picture() {
    let folder = folder();
    for of in [1, 3, 7, 20] {
        let middle = of / 2;
        let mut names = String::new();
        for (name, tiles) in
            [("c.png", format!("{middle}")), ("a.png", format!("0..{middle}")), ("b.png", format!("{middle}..{of}"))]
        {
            if tiles != "0..0" {
                part(&folder, &tiles, of, name);
                names = format!("{names} {name}");
            }
        }
        // In any order, and with one tile twice.
        folder.succeed(&format!("merge {names} -o merged.png"));
        assert!(folder.read("merged.png") == folder.read("whole.png"), "{of}");
    }
    folder.succeed(&format!("render {SETTINGS} -o built-in.png"));
    for tile in 0..2 {
        folder.succeed(&format!("render {SETTINGS} --tiles {tile} --of 2 -o {tile}.png -s kdtree -t {}", tile + 1));
    }
    folder.succeed("merge 0.png 1.png -o merged.png");
    assert!(folder.read("merged.png") == folder.read("built-in.png"));
}

#[test]
fn a_part_is_continued_and_a_strange_file_left_alone() {
    let folder = folder();
    let all = part(&folder, "2..9", 10, "fresh.png");
    let first = part(&folder, "2..5", 10, "part.png");
    let rest = part(&folder, "2..9", 10, "part.png");
    let rays = |text: &str| -> u32 {
        let line = text.lines().find(|line| line.contains("depth 0")).unwrap_or("0");
        line.split_whitespace().find_map(|word| word.replace(',', "").parse().ok().filter(|n| *n > 1)).unwrap_or(0)
    };
    assert_eq!((rays(&all), rays(&first), rays(&rest)), (24 * 14, 24 * 6, 24 * 8));
    assert!(folder.read("part.png") == folder.read("fresh.png"));
    // Done already: nothing is drawn.
    assert_eq!(rays(&part(&folder, "2..9", 10, "part.png")), 0);
    for strange in [b"no picture".to_vec(), folder.read("whole.png"), folder.read("part.png")[..300].to_vec()] {
        folder.write("strange.png", &strange);
        let error = folder.refuse(&format!("render tetrahedron.obj {SETTINGS} --tiles 2..9 --of 10 -o strange.png"));
        assert!(error.contains("strange.png: stands there and is no part of a picture: give another -o"), "{error}");
        assert!(folder.read("strange.png") == strange);
    }
    // What was drawn with other settings is not continued.
    folder.succeed("render tetrahedron.obj --size 24x20 --samples 2 --tiles 2..5 --of 10 -o part.png");
    part(&folder, "2..9", 10, "part.png");
    assert!(folder.read("part.png") == folder.read("fresh.png"));
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let folder = folder();
    part(&folder, "0..4", 10, "a.png");
    part(&folder, "4..10", 10, "b.png");
    part(&folder, "5..10", 10, "late.png");
    let refuse = |parts: &str, why: &str| {
        let error = folder.refuse(&format!("merge {parts} -o merged.png"));
        assert!(error.contains(why), "{parts}: {error}");
    };
    refuse("a.png", "tiles 4..10 of 10 are missing");
    refuse("b.png", "tiles 0..4 of 10 are missing");
    refuse("late.png a.png", "tiles 4..5 of 10 are missing");
    refuse("a.png none.png", "none.png: no such file");
    refuse("a.png whole.png", "whole.png: is no part of a picture");
    refuse("a.png tetrahedron.obj", "tetrahedron.obj: is no part of a picture (it is no PNG, or a damaged one)");
    refuse("a.png .", ".: is a directory: name a file in it");
    folder.succeed(&format!("render {SETTINGS} --tiles 4..10 --of 10 -o scene.png"));
    refuse("a.png scene.png", "scene.png: of another scene than a.png");
    folder.succeed("render tetrahedron.obj --size 24x20 --samples 2 --tiles 4..10 --of 10 -o settings.png");
    refuse("a.png settings.png", "settings.png: drawn with other settings than a.png");
    part(&folder, "8..20", 20, "finer.png");
    refuse("a.png finer.png", "finer.png: divided into other tiles than a.png");
    let older = folder.read("b.png");
    let at = older.windows(6).position(|bytes| bytes == b"0.1.0-").unwrap();
    // A text chunk with another version in it, and the checksum that belongs to it.
    let mut older = older;
    older[at] = b'9';
    let start = at - "hitscan:picture\0".len() - 4;
    let length = u32::from_be_bytes(older[start - 4..start].try_into().unwrap()) as usize + 4;
    let sum = crc(&older[start..start + length]);
    older[start + length..start + length + 4].copy_from_slice(&sum.to_be_bytes());
    folder.write("older.png", &older);
    refuse("a.png older.png", "older.png: drawn by another version than a.png");
    // A damaged part is none.
    older[start + length] ^= 1;
    folder.write("damaged.png", older);
    refuse("a.png damaged.png", "damaged.png: is no part");
    for options in ["--tiles 0..5", "--of 5", "--tiles 5..3 --of 9", "--tiles 0 --of 0", "--tiles 9..11 --of 10"] {
        folder.refuse(&format!("render tetrahedron.obj {SETTINGS} {options}"));
    }
    let error = folder.refuse(&format!("render tetrahedron.obj {SETTINGS} --tiles 7 --of 4"));
    assert!(error.contains("there are tiles 0 to 3"), "{error}");
    let error = folder.refuse(&format!("render tetrahedron.obj {SETTINGS} --tiles 0 --of 21"));
    assert!(error.contains("20 rows"), "{error}");
}

/// The checksum of PNG chunks.
fn crc(bytes: &[u8]) -> u32 {
    let step = |sum: u32, byte: &u8| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 })
    };
    !bytes.iter().fold(u32::MAX, step)
}
