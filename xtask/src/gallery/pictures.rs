//! Pictures of the docs that commands of the program draw.

use crate::program;
use crate::workspace::Verdict;
use std::path::Path;

/// A command of the program, and the pictures that it draws.
struct Drawing {
    /// Arguments without `--out`.
    args: &'static [&'static str],
    /// File in the output folder, and file below `docs/pictures`.
    pictures: &'static [(&'static str, &'static str)],
}

/// The pictures in the order of their time: some minutes in all.
const DRAWINGS: &[Drawing] = &[
    Drawing { args: &["experiment", "corridor"], pictures: &[("corridor.png", "docking-scenarios.png")] },
    Drawing { args: &["demo"], pictures: &[("map.png", "demo.png")] },
    Drawing { args: &["demo", "--scene", "house"], pictures: &[("map.png", "exploration.png")] },
    Drawing { args: &["experiment", "poses", "--seeds", "1"], pictures: &[("paths.png", "poses.png")] },
    Drawing {
        args: &["experiment", "obstacles", "--seeds", "1"],
        pictures: &[("seed-1.png", "gallery/obstacles.png")],
    },
    Drawing {
        args: &["experiment", "barn", "--worlds", "150-150"],
        pictures: &[("median.png", "gallery/barn.png")],
    },
    Drawing {
        args: &["experiment", "mrpb", "--only", "room02 2"],
        pictures: &[("room02-2-seed-1.png", "gallery/mrpb.png")],
    },
    Drawing {
        args: &["map", "../shared/data/laser/killian_g2o.log"],
        pictures: &[("overview.png", "mapping_killian.png")],
    },
];

/// Draws the pictures whose names contain one of `words`, or all without words. A command that fails is named; the others are drawn.
pub fn draw(root: &Path, words: &[String]) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let is_wanted = |drawing: &&Drawing| {
        let names = || drawing.pictures.iter().map(|(_, file)| *file);
        words.is_empty() || names().any(|name| words.iter().any(|word| name.contains(word.as_str())))
    };
    let mut failures = 0;
    for drawing in DRAWINGS.iter().filter(is_wanted) {
        if let Err(why) = draw_one(root, &trundle, drawing) {
            println!("not drawn: {why}");
            failures += 1;
        }
    }
    Ok(failures == 0)
}

fn draw_one(root: &Path, trundle: &Path, drawing: &Drawing) -> Result<(), String> {
    let out = program::scratch(root, "pictures")?;
    let folder = out.display().to_string();
    if !program::ends_well(trundle, &[drawing.args, &["--quiet", "--out", &folder]].concat())? {
        return Err(drawing.args.join(" "));
    }
    for (drawn, file) in drawing.pictures {
        let (drawn, file) = (out.join(drawn), root.join("docs/pictures").join(file));
        std::fs::copy(&drawn, &file)
            .map_err(|e| format!("cannot copy {} to {}: {e}", drawn.display(), file.display()))?;
        println!("wrote {}", file.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::root;

    /// A picture that no page shows would be drawn for nothing.
    #[test]
    fn every_drawn_picture_exists_and_is_shown() {
        let root = root();
        let mut pages = std::fs::read_to_string(root.join("README.md")).unwrap();
        for page in crate::markdown::pages(&root.join("docs")).unwrap() {
            pages.push_str(&std::fs::read_to_string(page).unwrap());
        }
        for (_, file) in DRAWINGS.iter().flat_map(|drawing| drawing.pictures) {
            assert!(root.join("docs/pictures").join(file).is_file(), "docs/pictures/{file} is missing");
            assert!(pages.contains(&format!("pictures/{file})")), "{file} is shown nowhere");
        }
    }
}
