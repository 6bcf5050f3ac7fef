//! The decoder of the Kinect V2, its packets and dumps, compared with a forward model.

use crate::fixtures::best_ms;
use crate::kinect2_model::{HEIGHT, Random, Surface, WIDTH, camera, p0, packed_images};
use proptest::prelude::*;
use std::io::BufReader;
use std::sync::LazyLock;
use std::time::Duration;
use trundle_core::DepthImage;
use trundle_drivers::camera::DepthCamera;
use trundle_drivers::camera::kinect2::layout::{IMAGE_BYTES, MODULATION_HZ, wrap_distance_m};
use trundle_drivers::camera::kinect2::packets::FOOTER_BYTES;
use trundle_drivers::camera::kinect2::{
    DecoderConfig, DepthDecoder, DumpCamera, DumpReader, DumpWriter, FrameAssembler, Kinect2Calibration,
    SubPacket, SubPacketParser, parse_dump_header,
};
use trundle_drivers::camera::pixels::depth_from_raw;

/// Depths of the nine steps \[m\].
fn step_depth(step: usize) -> f64 {
    0.5 + 0.5 * step as f64
}

/// Above: nine steps from 0.5 to 4.5 m. Below: a plane from 0.6 to 4.4 m, with a dark and a shining square.
fn scene(x: usize, y: usize) -> Surface {
    let albedo = 0.6 + 0.4 * ((x / 16 + y / 16) % 2) as f64;
    if y < HEIGHT / 2 {
        return (step_depth(x * 9 / WIDTH), albedo);
    }
    let depth = 1.0 / (1.0 / 0.6 + (1.0 / 4.4 - 1.0 / 0.6) * x as f64 / WIDTH as f64);
    match (x, y) {
        (100..150, 300..340) => (depth, 60.0),
        (300..350, 300..340) => (depth, 0.01),
        _ => (depth, albedo),
    }
}

/// Whether the depth or the light changes within `margin` pixels.
fn is_near_edge(x: usize, y: usize, margin: usize) -> bool {
    let own = scene(x, y);
    let around = |centre: usize, side: usize| centre.saturating_sub(margin)..(centre + margin + 1).min(side);
    let is_other = |other: Surface| {
        (other.0 - own.0).abs() > 0.1 || (other.1 > 1.0) != (own.1 > 1.0) || (other.1 < 0.1) != (own.1 < 0.1)
    };
    around(y, HEIGHT).any(|v| around(x, WIDTH).any(|u| is_other(scene(u, v))))
}

static PACKED: LazyLock<[Vec<u8>; 10]> = LazyLock::new(|| packed_images(scene, &p0(), 3));

fn calibration() -> Kinect2Calibration {
    Kinect2Calibration { p0: p0(), camera: camera(), range_offset_m: 0.0 }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Errors \[m\] of the pixels away from edges, and their share without depth.
fn errors(depth: &DepthImage, is_of: impl Fn(usize, usize) -> bool) -> (Vec<f64>, f64) {
    let (mut errors, mut empty) = (Vec::new(), 0usize);
    for (x, y) in (2..HEIGHT - 2).flat_map(|y| (2..WIDTH - 2).map(move |x| (x, y))) {
        let (truth, albedo) = scene(x, y);
        if (0.1..=1.0).contains(&albedo) && is_of(x, y) && !is_near_edge(x, y, 2) {
            let found = depth[(x, y)] as f64;
            if found > 0.0 { errors.push(found - truth) } else { empty += 1 }
        }
    }
    let share = empty as f64 / (errors.len() + empty) as f64;
    (errors, share)
}

#[test]
fn depth_of_steps_and_a_plane_is_exact_to_a_millimetre() {
    let mut decoder = DepthDecoder::new(&calibration(), DecoderConfig::default()).unwrap();
    println!("decoding: {:.1} ms", best_ms(|| _ = decoder.decode(&PACKED).unwrap()));
    let depth = decoder.decode(&PACKED).unwrap();
    let (all, empty) = errors(depth, |_, _| true);
    let typical = median(all.iter().map(|error| error.abs()).collect());
    let wraps = all.iter().filter(|error| error.abs() > 0.3).count();
    println!(
        "median |error| {:.2} mm, {:.3} % empty, {wraps} wraps of {}",
        1e3 * typical,
        100.0 * empty,
        all.len()
    );
    for step in 0..9 {
        let (errors, empty) = errors(depth, |x, y| y < HEIGHT / 2 && x * 9 / WIDTH == step);
        let bias = median(errors.clone());
        let spread = 1.4826 * median(errors.iter().map(|error| (error - bias).abs()).collect());
        println!(
            "{} m: bias {:.2} mm, spread {:.2} mm, {:.3} % empty",
            step_depth(step),
            1e3 * bias,
            1e3 * spread,
            100.0 * empty
        );
        assert!(bias.abs() < 0.001, "{} m: {bias}", step_depth(step));
    }
    assert!(typical < 0.001, "{typical}");
    assert_eq!(wraps, 0);
    assert!(empty < 0.002, "{empty}");
}

#[test]
fn the_filters_reduce_noise_and_flying_pixels() {
    let mut plain = DecoderConfig::default();
    plain.smooths_phasors = false;
    plain.removes_flying_pixels = false;
    let mut decoder = DepthDecoder::new(&calibration(), plain).unwrap();
    let (raw, _) = errors(decoder.decode(&PACKED).unwrap(), |_, _| true);
    let wraps = raw.iter().filter(|error| error.abs() > 0.3).count();
    let mut decoder = DepthDecoder::new(&calibration(), DecoderConfig::default()).unwrap();
    let (filtered, _) = errors(decoder.decode(&PACKED).unwrap(), |_, _| true);
    let typical = |errors: &[f64]| median(errors.iter().map(|error| error.abs()).collect());
    println!("median |error| {:.2} mm without filters, {wraps} wraps", 1e3 * typical(&raw));
    assert!(typical(&filtered) < 0.5 * typical(&raw));
    assert!(wraps * 10_000 < raw.len(), "{wraps}");

    let mixed = |x: usize, y: usize| {
        if x == 200 {
            (1.5, 0.8)
        } else if x < 200 {
            (1.0, 0.8)
        } else {
            scene(400, y % 200)
        }
    };
    let depth = decoder.decode(&packed_images(mixed, &p0(), 5)).unwrap();
    let flying = (5..HEIGHT - 5).filter(|y| depth[(200, *y)] > 0.0).count();
    let kept = (5..HEIGHT - 5).filter(|y| depth[(198, *y)] > 0.0).count();
    assert!(flying < 10 && kept > HEIGHT - 20, "{flying} flying, {kept} kept");
}

#[test]
fn smoothing_keeps_edges() {
    let two = |x: usize, _: usize| if x < 200 { (1.0, 0.8) } else { (1.4, 0.8) };
    let mut plain = DecoderConfig::default();
    plain.removes_flying_pixels = false;
    let mut decoder = DepthDecoder::new(&calibration(), plain).unwrap();
    let depth = decoder.decode(&packed_images(two, &p0(), 8)).unwrap();
    for (x, truth) in [(198, 1.0), (199, 1.0), (200, 1.4), (201, 1.4)] {
        let errors = (5..HEIGHT - 5).map(|y| (depth[(x, y)] as f64 - truth).abs()).collect();
        let error = median(errors);
        assert!(error < 0.002, "column {x}: {error}");
    }
}

#[test]
fn saturated_dark_and_near_pixels_have_no_depth() {
    let mut decoder = DepthDecoder::new(&calibration(), DecoderConfig::default()).unwrap();
    let depth = decoder.decode(&PACKED).unwrap().clone();
    let share = |xs: std::ops::Range<usize>| {
        let pixels = (302..338).flat_map(|y| xs.clone().map(move |x| (x, y)));
        let all: Vec<bool> = pixels.map(|at| depth[at] == 0.0).collect();
        all.iter().filter(|is_empty| **is_empty).count() as f64 / all.len() as f64
    };
    assert_eq!((share(102..148), share(302..348), share(202..248)), (1.0, 1.0, 0.0));
    assert!(decoder.amplitude().data().iter().zip(depth.data()).all(|(a, d)| *d == 0.0 || *a >= 30.0));
    let near = decoder.decode(&packed_images(|_, _| (0.3, 0.05), &p0(), 1)).unwrap();
    assert!(near.data()[WIDTH * 200 + 250] == 0.0, "nearer than the valid range");
}

#[test]
fn the_three_frequencies_agree_again_only_after_18_7_metres() {
    let wraps: [f64; 3] = std::array::from_fn(wrap_distance_m);
    let period = 299_792_458.0 / (2.0 * 8e6);
    assert!(wraps.iter().all(|wrap| (period / wrap - (period / wrap).round()).abs() < 1e-9));
    assert_eq!(MODULATION_HZ.map(|hz| hz % 8e6), [0.0; 3]);
    let mut far = DecoderConfig::default();
    far.max_range_m = 18.0;
    let mut decoder = DepthDecoder::new(&calibration(), far).unwrap();
    let depth = decoder.decode(&packed_images(|_, _| (14.0, 40.0), &p0(), 2)).unwrap();
    let errors: Vec<f64> =
        depth.data().iter().filter(|d| **d > 0.0).map(|d| (*d as f64 - 14.0).abs()).collect();
    assert!(errors.len() > WIDTH * HEIGHT * 9 / 10 && median(errors) < 0.01);
}

#[test]
fn settings_and_sizes_out_of_range_are_named() {
    let refused = |calibration: &Kinect2Calibration, config| {
        DepthDecoder::new(calibration, config).unwrap_err().to_string()
    };
    let mut config = DecoderConfig::default();
    config.max_range_m = 30.0;
    assert_eq!(refused(&calibration(), config), "max_range_m is 30 m, expected 0.4 to 18.73");
    let mut short = calibration();
    short.p0[1].pop();
    let error = refused(&short, DecoderConfig::default());
    assert_eq!(error, "P0 table 1 of a Kinect V2 is 217087 numbers, expected 217088");
    let mut decoder = DepthDecoder::new(&calibration(), DecoderConfig::default()).unwrap();
    let mut packed = PACKED.clone();
    packed[4].pop();
    let error = decoder.decode(&packed).unwrap_err().to_string();
    assert_eq!(error, "packed image of a Kinect V2 is 298495 bytes, expected 298496");
}

/// The bytes of a sub-packet on the wire.
fn on_wire(packet: &SubPacket) -> Vec<u8> {
    let fields = [0, 9, packet.ticks, packet.sequence, packet.subsequence, packet.bytes.len() as u32];
    let mut bytes = packet.bytes.clone();
    bytes.extend(fields.into_iter().flat_map(u32::to_le_bytes));
    bytes.resize(packet.bytes.len() + FOOTER_BYTES, 0xaa);
    bytes
}

fn packets(sequence: u32, ticks: u32) -> Vec<SubPacket> {
    let packet = |(index, bytes): (usize, &Vec<u8>)| SubPacket {
        ticks,
        sequence,
        subsequence: index as u32,
        bytes: bytes.clone(),
    };
    PACKED.iter().enumerate().map(packet).collect()
}

#[test]
fn sub_packets_are_cut_out_of_transfers_and_joined_to_frames() {
    let mut parser = SubPacketParser::default();
    let mut assembler = FrameAssembler::default();
    let mut frames = Vec::new();
    for (frame, ticks) in [(1, u32::MAX - 10), (2, 22), (3, 289), (4, 556)] {
        for packet in packets(frame, ticks) {
            let mut bytes = on_wire(&packet);
            match (frame, packet.subsequence) {
                (2, 4) => continue,
                (3, 2) => drop(bytes.drain(1000..1100)),
                _ => {}
            }
            let found = bytes.chunks(33_792).filter_map(|transfer| parser.push(transfer)).collect::<Vec<_>>();
            frames.extend(found.into_iter().filter_map(|packet| assembler.push(packet)));
        }
    }
    assert_eq!(frames.iter().map(|frame| frame.sequence).collect::<Vec<_>>(), [1, 4]);
    assert_eq!(frames[1].stamp - frames[0].stamp, 567.0 * 0.000125, "the time passed its overflow");
    assert!(frames[0].images == *PACKED);
    assert_eq!(assembler.dropped(), 2);
    assert_eq!(parser.skipped_bytes() as usize, IMAGE_BYTES + FOOTER_BYTES - 100);
}

#[test]
fn a_dump_gives_its_frames_through_the_camera_trait() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let mut writer = DumpWriter::new(file.reopen().unwrap(), &calibration()).unwrap();
    let incomplete = packets(2, 267).into_iter().skip(1);
    let all = packets(1, 0).into_iter().chain(incomplete).chain(packets(3, 534));
    all.for_each(|packet| writer.write(&packet).unwrap());
    let mut camera = DumpCamera::open(file.path(), DecoderConfig::default()).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = camera.next_frame(Duration::ZERO).unwrap() {
        frames.push(frame);
    }
    assert!(camera.has_ended() && camera.dropped() == 1);
    let stamps: Vec<i64> = frames.iter().map(|frame| frame.depth.device_stamp.nanos).collect();
    assert_eq!(stamps, [0, 66_750_000]);
    let mut depth = DepthImage::default();
    depth_from_raw(&frames[1].depth, 1.0, &mut depth).unwrap();
    let mut decoder = DepthDecoder::new(&calibration(), DecoderConfig::default()).unwrap();
    assert_eq!(&depth, decoder.decode(&PACKED).unwrap());
    assert!(frames[1].color.bytes.iter().any(|gray| *gray > 100));
}

fn read(bytes: &[u8]) -> Result<DumpReader<BufReader<&[u8]>>, String> {
    DumpReader::new(BufReader::new(bytes)).map_err(|error| error.to_string())
}

#[test]
fn damaged_dumps_are_refused_by_name() {
    let mut dump = DumpWriter::new(Vec::new(), &calibration()).unwrap().into_inner();
    assert!(read(&dump).unwrap().next_frame().unwrap().is_none());
    assert_eq!(read(&dump[..100_000]).unwrap_err(), "the dump ends within its P0 tables");
    assert!(read(b"{}\n").unwrap_err().starts_with("header of the dump: missing field `magic`"));
    let other = r#"{"magic":"x","version":1,"camera":{"width":9,"height":9,"fx":9,"fy":9,"cx":4,"cy":4}}"#;
    assert!(
        parse_dump_header(other.as_bytes()).unwrap_err().starts_with(r#"magic and version are ("x", 1)"#)
    );
    dump.extend([7; 20]);
    let error = read(&dump).unwrap().next_frame().unwrap_err().to_string();
    assert!(error.starts_with("a packet of the dump begins with [7, 7, 7, 7]"), "{error}");
}

proptest! {
    #[test]
    fn no_bytes_make_the_dump_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = parse_dump_header(&bytes);
        let _ = DumpReader::new(BufReader::new(&bytes[..]));
    }

    #[test]
    fn no_transfers_make_the_packet_parser_panic(
        lengths in prop::collection::vec(prop::sample::select(vec![0, 1, 151, 152, 153, 33_792, 298_648]), 0..12),
        has_footer in any::<u16>(),
    ) {
        let mut parser = SubPacketParser::default();
        let mut assembler = FrameAssembler::default();
        for (i, length) in lengths.into_iter().enumerate() {
            let mut transfer = vec![i as u8; length];
            if length >= FOOTER_BYTES && has_footer >> i & 1 == 1 {
                let footer = [0u32, 9, 5, 6, i as u32, IMAGE_BYTES as u32].map(u32::to_le_bytes).concat();
                transfer[length - FOOTER_BYTES..][..24].copy_from_slice(&footer);
            }
            if let Some(packet) = parser.push(&transfer) {
                prop_assert_eq!(packet.bytes.len(), IMAGE_BYTES);
                assembler.push(packet);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    #[test]
    fn no_measurements_make_the_decoder_panic(seed in any::<u64>()) {
        let mut random = Random(seed);
        let images = std::array::from_fn(|_| (0..IMAGE_BYTES).map(|_| random.next() as u8).collect());
        let mut decoder = DepthDecoder::new(&calibration(), DecoderConfig::default()).unwrap();
        let depth = decoder.decode(&images).unwrap();
        prop_assert!(depth.data().iter().all(|d| (0.0..=8.0).contains(d)));
    }
}
