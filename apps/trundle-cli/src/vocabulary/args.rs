//! The command line of `trundle vocabulary`.

use crate::common_args::Common;
use crate::output_args::OutputFileArg;
use clap::{Args, Subcommand};
use std::path::PathBuf;
use trundle::experiments::IndexRange;
use trundle::experiments::vocabulary::ImageSources;

/// `trundle vocabulary`
#[derive(Debug, Args)]
#[command(arg_required_else_help = true)]
pub struct VocabularyArgs {
    /// The action.
    #[command(subcommand)]
    pub command: VocabularyCommand,
}

/// Actions on a vocabulary.
#[derive(Debug, Subcommand)]
pub enum VocabularyCommand {
    /// Train a vocabulary on recorded images and on views of simulated scenes.
    Train(TrainArgs),
    /// Print the size of a vocabulary.
    Info(InfoArgs),
    /// Write a vocabulary in the text format of DBoW2, which ORB-SLAM programs read.
    Export(ExportArgs),
    /// Read a vocabulary in the text format of DBoW2.
    Import(ImportArgs),
    /// Measure the place recognition rate of one or more vocabularies.
    Recall(RecallArgs),
}

/// Sources of images.
#[derive(Debug, Args)]
pub struct Sources {
    /// TUM RGB-D folders.
    pub folders: Vec<PathBuf>,
    /// Frames of each folder: FIRST-LAST, from 0 [default: all]
    #[arg(long, value_name = "A-B")]
    pub frames: Option<IndexRange>,
    /// A scene for views, built in or a glTF file; may be repeated.
    #[arg(long = "scene", value_name = "NAME|FILE")]
    pub scenes: Vec<String>,
    /// Seeds of the furniture and textures of built-in scenes, and of the places: FIRST-LAST.
    #[arg(long, value_name = "A-B", default_value = "1-1")]
    pub seeds: IndexRange,
    /// Views of each scene and seed, at random places with clearance, by Kinect V2 and v1 alternately.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub views: u32,
    /// glTF files have z up instead of y.
    #[arg(long)]
    pub z_up: bool,
    /// Maximum number of ORB features per image.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub features_per_image: u32,
}

impl Sources {
    /// The sources that the arguments name.
    pub fn sources(&self) -> ImageSources {
        ImageSources {
            folders: self.folders.clone(),
            frames: self.frames,
            scenes: self.scenes.clone(),
            seeds: self.seeds,
            views: self.views as usize,
            z_up: self.z_up,
            features_per_image: self.features_per_image as usize,
        }
    }
}

/// `trundle vocabulary train`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle vocabulary train --scene room --scene house --seeds 1-4 --out own.voc"
)]
pub struct TrainArgs {
    /// Sources of images.
    #[command(flatten)]
    pub sources: Sources,
    /// A folder of descriptors from another program: one file per image, 32 bytes per descriptor.
    #[arg(long, value_name = "DIR")]
    pub descriptors: Option<PathBuf>,
    /// Children of a node.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub branching: usize,
    /// Levels below the root.
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub depth: usize,
    /// Seed of the clustering.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// The file to write.
    #[arg(long, value_name = "FILE")]
    pub out: OutputFileArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle vocabulary info`
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A vocabulary [default: the program's own]
    pub file: Option<PathBuf>,
}

/// `trundle vocabulary export`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle vocabulary export --dbow2 trundle_voc.txt")]
pub struct ExportArgs {
    /// A vocabulary [default: the program's own]
    pub file: Option<PathBuf>,
    /// The text file to write.
    #[arg(long, value_name = "FILE")]
    pub dbow2: OutputFileArg,
}

/// `trundle vocabulary import`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle vocabulary import ORBvoc.txt --out orb.voc")]
pub struct ImportArgs {
    /// A vocabulary in the text format of DBoW2.
    pub text: PathBuf,
    /// The file to write.
    #[arg(long, value_name = "FILE")]
    pub out: OutputFileArg,
}

/// `trundle vocabulary recall`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle vocabulary recall --scene office --seeds 91-93\n\n\
    A place is recognised when the view most like a second look at it was taken within 0.75 m and 25 deg of it.")]
pub struct RecallArgs {
    /// A vocabulary to measure; may be repeated [default: the program's own]
    #[arg(long = "vocabulary", value_name = "FILE")]
    pub vocabularies: Vec<PathBuf>,
    /// Sources of images.
    #[command(flatten)]
    pub sources: Sources,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}
