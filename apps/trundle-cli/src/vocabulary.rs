//! `trundle vocabulary`: train the words by which places are recognised, look at them, exchange them, measure them.

mod args;
mod file;
mod places;
mod recall;
mod scenery;
mod shots;

use crate::{Outcome, console};
use args::{ExportArgs, ImportArgs, InfoArgs, TrainArgs};
pub use args::{VocabularyArgs, VocabularyCommand};
use std::time::Instant;
use trundle::app::AppError;
use trundle::vision::{Descriptor, Vocabulary, VocabularyConfig};

/// Fewer descriptors than this a word make words of chance.
const FEWEST_A_WORD: usize = 2;

/// `trundle vocabulary ...`.
pub fn run(args: &VocabularyArgs) -> Result<Outcome, AppError> {
    match &args.command {
        VocabularyCommand::Train(args) => train(args)?,
        VocabularyCommand::Info(args) => info(args)?,
        VocabularyCommand::Export(args) => export(args)?,
        VocabularyCommand::Import(args) => import(args)?,
        VocabularyCommand::Recall(args) => recall::run(args)?,
    }
    Ok(Outcome::Reached)
}

fn train(args: &TrainArgs) -> Result<(), AppError> {
    let config = VocabularyConfig { branching: args.branching, depth: args.depth, ..Default::default() };
    let config = config.validated()?;
    let images = images(args)?;
    let descriptors: usize = images.iter().map(Vec::len).sum();
    if descriptors < FEWEST_A_WORD * config.branching {
        let wanted = FEWEST_A_WORD * config.branching;
        let problem =
            format!("{descriptors} descriptors in {} images, expected {wanted} or more", images.len());
        return Err(AppError::Input(problem));
    }
    let clock = Instant::now();
    let vocabulary = Vocabulary::train(&images, &config, args.seed)?;
    let seconds = clock.elapsed().as_secs_f64();
    file::write(&args.out, &vocabulary.to_bytes())?;
    if !args.common.quiet {
        let (images, words) = (images.len(), vocabulary.word_count());
        console::print(&format!(
            "{words} words from {descriptors} descriptors of {images} images, trained in {seconds:.1} s"
        ));
        console::print(&format!("See {}", args.out.display()));
    }
    Ok(())
}

/// The descriptors of every image to train on.
fn images(args: &TrainArgs) -> Result<Vec<Vec<Descriptor>>, AppError> {
    let mut images = args.descriptors.as_deref().map_or(Ok(Vec::new()), file::read_descriptors)?;
    if args.descriptors.is_none() || shots::check(&args.sources).is_ok() {
        let shots = shots::of(&args.sources, args.common.quiet)?;
        images.extend(shots.into_iter().map(|shot| shot.descriptors));
    }
    Ok(images)
}

fn info(args: &InfoArgs) -> Result<(), AppError> {
    let clock = Instant::now();
    let vocabulary = file::read_or_builtin(args.file.as_deref())?;
    let milliseconds = clock.elapsed().as_secs_f64() * 1e3;
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    console::print_table(&[
        row("words", vocabulary.word_count().to_string()),
        row("children of a node, at most", vocabulary.branching().to_string()),
        row("levels below the root, at most", vocabulary.depth().to_string()),
        row("size", format!("{} bytes", vocabulary.to_bytes().len())),
        row("read in", format!("{milliseconds:.1} ms")),
    ]);
    Ok(())
}

fn export(args: &ExportArgs) -> Result<(), AppError> {
    let vocabulary = file::read_or_builtin(args.file.as_deref())?;
    file::write(&args.dbow2, vocabulary.to_dbow2_text().as_bytes())?;
    console::print(&format!("{} words, see {}", vocabulary.word_count(), args.dbow2.display()));
    Ok(())
}

fn import(args: &ImportArgs) -> Result<(), AppError> {
    let vocabulary = file::read_dbow2(&args.text)?;
    file::write(&args.out, &vocabulary.to_bytes())?;
    console::print(&format!("{} words, see {}", vocabulary.word_count(), args.out.display()));
    Ok(())
}
