//! `trundle vocabulary`: trains, measures and converts the visual vocabulary of place recognition.

mod args;

use crate::console;
use crate::outcome::Outcome;
use crate::output_args::write_file;
use args::{ExportArgs, ImportArgs, InfoArgs, RecallArgs, TrainArgs};
pub use args::{VocabularyArgs, VocabularyCommand};
use std::time::Instant;
use trundle::app::AppError;
use trundle::app::vocabulary_file::{
    named_vocabularies, read_dbow2_vocabulary, vocabulary_or_builtin, vocabulary_rows,
};
use trundle::experiments::vocabulary::{PlaceRecall, VocabularyTraining, recall_table};
use trundle::vision::VocabularyConfig;

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
    let training = VocabularyTraining {
        sources: args.sources.sources(),
        descriptors: args.descriptors.clone(),
        config: VocabularyConfig::of_tree(args.branching, args.depth),
        seed: args.seed,
    };
    let clock = Instant::now();
    let trained = training.train(&console::StepDisplay::new(args.common.quiet))?;
    let seconds = clock.elapsed().as_secs_f64();
    write_file(&args.out, &trained.vocabulary.to_bytes())?;
    if !args.common.quiet {
        console::print(&format!("{trained}, in {seconds:.1} s"));
        console::print_see(&args.out);
    }
    Ok(())
}

/// A row for each source of images, a column for each vocabulary.
fn recall(args: &RecallArgs) -> Result<(), AppError> {
    let sources = args.sources.sources();
    sources.require_any()?;
    let (names, vocabularies): (Vec<_>, Vec<_>) = named_vocabularies(&args.vocabularies)?.into_iter().unzip();
    let display = console::StepDisplay::new(args.common.quiet);
    let measured = PlaceRecall::measure(&vocabularies, &sources, &display)?;
    console::print_table(&recall_table(&names, &measured));
    Ok(())
}

fn info(args: &InfoArgs) -> Result<(), AppError> {
    let clock = Instant::now();
    let vocabulary = vocabulary_or_builtin(args.file.as_deref())?;
    let milliseconds = clock.elapsed().as_secs_f64() * 1e3;
    console::print_table(&vocabulary_rows(&vocabulary, milliseconds));
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
