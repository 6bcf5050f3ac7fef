//! Recordings of cameras converted into TUM folders.

use std::fs::File;
use std::path::{Path, PathBuf};
use trundle_app::convert::{ConversionInput, Converted, SequenceForm};
use trundle_app::sequence_input::{SequenceInput, SequenceOptions};
use trundle_core::{Distortion, PinholeCamera, RgbdImage, Stamp};
use trundle_drivers::camera::kinect2::layout::{COLUMNS, IMAGE_BYTES, IMAGE_COUNT, PIXEL_COUNT, ROWS};
use trundle_drivers::camera::kinect2::{DumpWriter, Kinect2Calibration, SubPacket};
use trundle_drivers::camera::pipe::StreamWriter;
use trundle_drivers::camera::{CameraFrame, CameraInfo, PixelFormat, RawImage, StreamInfo};
use trundle_io::OutputFolder;

const SIZE: (usize, usize) = (64, 48);

fn lens((width, height): (usize, usize)) -> PinholeCamera {
    let middle = (width as f64 / 2.0, height as f64 / 2.0);
    PinholeCamera::new((width, height), (width as f64, width as f64), middle, Distortion::default()).unwrap()
}

fn info() -> CameraInfo {
    let stream = |format| StreamInfo { format, camera: lens(SIZE), rate_hz: 30.0 };
    CameraInfo {
        name: "test".into(),
        serial: String::new(),
        firmware: String::new(),
        usb: None,
        color: stream(PixelFormat::Rgb8),
        depth: stream(PixelFormat::Depth16),
        depth_unit_m: 0.001,
        color_from_depth: None,
        delay_s: 0.0,
        is_live: true,
    }
}

fn frame(stamp: Stamp, depth_mm: u16) -> CameraFrame {
    let pixels = SIZE.0 * SIZE.1;
    let depth = std::iter::repeat_n(depth_mm.to_le_bytes(), pixels).flatten().collect();
    CameraFrame {
        color: RawImage::packed(PixelFormat::Rgb8, SIZE, [200, 100, 50].repeat(pixels), stamp),
        depth: RawImage::packed(PixelFormat::Depth16, SIZE, depth, stamp),
    }
}

/// A camera stream in a file: three frames, and one out of order.
fn stream(folder: &Path) -> PathBuf {
    let file = folder.join("recorded.stream");
    let mut writer = StreamWriter::new(File::create(&file).unwrap(), &info()).unwrap();
    for (ms, depth) in [(0, 1000), (33, 1500), (20, 9999), (66, 2000)] {
        writer.write(&frame(Stamp::from_nanos(ms * 1_000_000), depth)).unwrap();
    }
    file
}

/// A dump of a Kinect V2 with two frames.
fn dump(folder: &Path) -> PathBuf {
    let file = folder.join("kinect.dump");
    let p0 = std::array::from_fn(|_| vec![0; PIXEL_COUNT]);
    let calibration = Kinect2Calibration { p0, camera: lens((COLUMNS, ROWS)), range_offset_m: 0.0 };
    let mut writer = DumpWriter::new(File::create(&file).unwrap(), &calibration).unwrap();
    for sequence in 0..2 {
        for subsequence in 0..IMAGE_COUNT as u32 {
            let bytes = vec![0x5A; IMAGE_BYTES];
            let packet = SubPacket { ticks: 267 * sequence, sequence, subsequence, bytes };
            writer.write(&packet).unwrap();
        }
    }
    file
}

/// Converts the camera `name` into a TUM folder; the counts and the images.
fn converted(name: &str, out: &Path) -> (Converted, Vec<RgbdImage>) {
    let path = PathBuf::from(name);
    let input = ConversionInput::open(&SequenceOptions::new(&path), SequenceForm::TumFolder).unwrap();
    let folder = OutputFolder::create(out).unwrap();
    let counts = input.convert(SequenceForm::TumFolder, &folder, &()).unwrap();
    let sequence = SequenceInput::open(&SequenceOptions::new(&folder.commit().unwrap())).unwrap();
    (counts, sequence.frames().unwrap().map(|frame| frame.unwrap().decode().unwrap()).collect())
}

fn refused(name: &str, form: SequenceForm) -> String {
    let path = PathBuf::from(name);
    ConversionInput::open(&SequenceOptions::new(&path), form).err().unwrap().to_string()
}

#[test]
fn a_recorded_stream_keeps_its_stamps_colours_and_depths() {
    let scratch = tempfile::tempdir().unwrap();
    let name = format!("stream:{}", stream(scratch.path()).display());
    let (counts, images) = converted(&name, &scratch.path().join("out"));
    assert_eq!((counts.images, counts.skipped), (3, 1), "a frame out of order is left out");
    let stamps: Vec<i64> = images.iter().map(|image| image.stamp().nanos / 1_000_000).collect();
    assert_eq!(stamps, [0, 33, 66]);
    for (image, depth) in images.iter().zip([1.0, 1.5, 2.0]) {
        assert!(image.depth().data().iter().all(|found| (found - depth).abs() < 1e-4), "{depth} m");
        assert!(image.color().data().iter().all(|color| *color == [200, 100, 50]));
    }
}

#[test]
fn a_dump_of_a_kinect_v2_becomes_a_folder_of_images() {
    let scratch = tempfile::tempdir().unwrap();
    let name = format!("kinect2-dump:{}", dump(scratch.path()).display());
    let (counts, images) = converted(&name, &scratch.path().join("out"));
    assert_eq!((counts.images, counts.skipped), (2, 0));
    assert_eq!((images[0].depth().width(), images[0].depth().height()), (COLUMNS, ROWS));
    assert!((images[1].stamp() - images[0].stamp() - 267.0 * 0.000_125).abs() < 1e-5);
}

#[test]
fn what_is_no_recording_and_what_does_not_suit_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let name = format!("stream:{}", stream(scratch.path()).display());
    for form in [SequenceForm::RosBag, SequenceForm::Recording] {
        assert!(refused(&name, form).contains("expected --to tum"), "{form:?}");
    }
    let missing = refused("kinect2-dump:/nowhere/x.dump", SequenceForm::TumFolder);
    assert!(missing.contains("/nowhere/x.dump"), "{missing}");
    let folder = scratch.path().join("live");
    std::fs::create_dir_all(folder.join("color")).unwrap();
    std::fs::create_dir_all(folder.join("depth")).unwrap();
    let header = std::fs::read(stream(scratch.path())).unwrap();
    let end = header.iter().position(|byte| *byte == b'\n').unwrap();
    std::fs::write(folder.join("camera.json"), &header[..=end]).unwrap();
    let live = refused(&format!("folder:{}", folder.display()), SequenceForm::TumFolder);
    assert!(live.contains("is live, expected a recording"), "{live}");
    let path = PathBuf::from(&name);
    let mut options = SequenceOptions::new(&path);
    options.depth_scale = Some(1000.0);
    let idle = ConversionInput::open(&options, SequenceForm::TumFolder).err().unwrap().to_string();
    assert!(idle.contains("have no effect on stream:"), "{idle}");
}
