//! `trundle vocabulary`: trains, measures and exchanges the visual vocabulary by which places are recognised.

mod args;

use crate::console;
use crate::outcome::Outcome;
use crate::output_args::write_file;
use args::{ExportArgs, ImportArgs, InfoArgs, RecallArgs, TrainArgs};
pub use args::{VocabularyArgs, VocabularyCommand};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
use trundle::app::AppError;
use trundle::app::vocabulary_file::{
    read_dbow2_vocabulary, read_descriptors, read_vocabulary, vocabulary_or_builtin,
};
use trundle::experiments::vocabulary::{PlaceRecall, described_views, recall_table};
use trundle::vision::{Descriptor, Vocabulary, VocabularyConfig};

/// Descriptors for each child of a node. With fewer a word is an accident of the images. Source: ours.
const MIN_DESCRIPTORS_PER_CHILD: usize = 2;

/// `trundle vocabulary ...`.
pub fn run(args: &VocabularyArgs) -> Result<Outcome, AppError> {
    match &args.command {
        VocabularyCommand::Train(args) => train(args)?,
        VocabularyCommand::Info(args) => info(args)?,
        VocabularyCommand::Export(args) => export(args)?,
        VocabularyCommand::Import(args) => import(args)?,
        VocabularyCommand::Recall(args) => recall(args)?,
    }
    Ok(Outcome::Reached)
}

fn train(args: &TrainArgs) -> Result<(), AppError> {
    let config = VocabularyConfig { branching: args.branching, depth: args.depth, ..Default::default() };
    let config = config.validated()?;
    let images = images(args)?;
    let descriptors: usize = images.iter().map(Vec::len).sum();
    if descriptors < MIN_DESCRIPTORS_PER_CHILD * config.branching {
        let wanted = MIN_DESCRIPTORS_PER_CHILD * config.branching;
        let problem =
            format!("{descriptors} descriptors in {} images, expected {wanted} or more", images.len());
        return Err(AppError::Input(problem));
    }
    let clock = Instant::now();
    let vocabulary = Vocabulary::train(&images, &config, args.seed)?;
    let seconds = clock.elapsed().as_secs_f64();
    write_file(&args.out, &vocabulary.to_bytes())?;
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
    let mut images = args.descriptors.as_deref().map_or(Ok(Vec::new()), read_descriptors)?;
    let sources = args.sources.sources();
    if args.descriptors.is_none() || sources.require_any().is_ok() {
        let views = described_views(&sources, &console::StepDisplay::new(args.common.quiet))?;
        images.extend(views.into_iter().map(|view| view.descriptors));
    }
    Ok(images)
}

/// A row for each source of images, a column for each vocabulary.
fn recall(args: &RecallArgs) -> Result<(), AppError> {
    let sources = args.sources.sources();
    sources.require_any()?;
    let (names, vocabularies): (Vec<_>, Vec<_>) = vocabularies(args)?.into_iter().unzip();
    let display = console::StepDisplay::new(args.common.quiet);
    let measured = PlaceRecall::measure(&vocabularies, &sources, &display)?;
    console::print_table(&recall_table(&names, &measured));
    Ok(())
}

/// The vocabularies to measure with their names.
fn vocabularies(args: &RecallArgs) -> Result<Vec<(String, Arc<Vocabulary>)>, AppError> {
    if args.vocabularies.is_empty() {
        return Ok(vec![("built in".to_owned(), Vocabulary::builtin())]);
    }
    let name = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    args.vocabularies.iter().map(|path| Ok((name(path), Arc::new(read_vocabulary(path)?)))).collect()
}

fn info(args: &InfoArgs) -> Result<(), AppError> {
    let clock = Instant::now();
    let vocabulary = vocabulary_or_builtin(args.file.as_deref())?;
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
    let vocabulary = vocabulary_or_builtin(args.file.as_deref())?;
    write_file(&args.dbow2, vocabulary.to_dbow2_text().as_bytes())?;
    console::print(&format!("{} words, see {}", vocabulary.word_count(), args.dbow2.display()));
    Ok(())
}

fn import(args: &ImportArgs) -> Result<(), AppError> {
    let vocabulary = read_dbow2_vocabulary(&args.text)?;
    write_file(&args.out, &vocabulary.to_bytes())?;
    console::print(&format!("{} words, see {}", vocabulary.word_count(), args.out.display()));
    Ok(())
}
