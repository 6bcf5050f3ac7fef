//! The packets of a Kinect V2 by USB, as made byte streams with every fault of a transfer.

use trundle_drivers::camera::kinect2::PackedFrame;
use trundle_drivers::camera::kinect2::layout::{IMAGE_BYTES, IMAGE_COUNT};
use trundle_drivers::camera::kinect2::usb::color_packets::{
    ColorPacket, ColorPackets, FOOTER_BYTES, FOOTER_MAGIC, HEADER_BYTES, HEADER_MAGIC, MAX_PACKET_BYTES,
};
use trundle_drivers::camera::kinect2::usb::depth_packets::{DepthPackets, MIN_PACKET_BYTES};

/// Size of a bulk transfer of colour \[bytes\].
const TRANSFER_BYTES: usize = 0x4000;

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// The isochronous packets of one image and its footer; the last one is empty.
fn image(sequence: u32, subsequence: u32) -> Vec<Vec<u8>> {
    let mut bytes = vec![(sequence * 16 + subsequence) as u8; IMAGE_BYTES];
    bytes.extend(words(&[0, 9, sequence * 267, sequence, subsequence, IMAGE_BYTES as u32]));
    bytes.extend([0; 128]);
    let mut packets: Vec<Vec<u8>> = bytes.chunks(MIN_PACKET_BYTES).map(<[u8]>::to_vec).collect();
    packets.push(Vec::new());
    packets
}

/// The isochronous packets of a frame, image by image.
fn frame(sequence: u32) -> Vec<Vec<Vec<u8>>> {
    (0..IMAGE_COUNT as u32).map(|subsequence| image(sequence, subsequence)).collect()
}

fn push_all<'a>(
    depth: &mut DepthPackets,
    packets: impl IntoIterator<Item = &'a Vec<u8>>,
) -> Vec<PackedFrame> {
    packets.into_iter().filter_map(|packet| depth.push(packet)).collect()
}

fn assert_whole(frame: &PackedFrame, sequence: u32) {
    assert_eq!(frame.sequence, sequence);
    for (subsequence, image) in frame.images.iter().enumerate() {
        assert_eq!(image.len(), IMAGE_BYTES);
        assert!(
            image.iter().all(|byte| *byte == (sequence * 16 + subsequence as u32) as u8),
            "{subsequence}"
        );
    }
}

#[test]
fn packets_become_whole_frames_with_their_times() {
    let mut depth = DepthPackets::default();
    for sequence in 1..4 {
        let found = push_all(&mut depth, frame(sequence).iter().flatten());
        assert_eq!(found.len(), 1);
        assert_whole(&found[0], sequence);
        assert_eq!(found[0].stamp.nanos, i64::from(sequence) * 267 * 125_000);
    }
    assert_eq!((depth.dropped(), depth.skipped_bytes()), (0, 0));
}

#[test]
fn a_lost_or_cut_packet_costs_one_frame_only() {
    for fault in 0..3 {
        let mut depth = DepthPackets::default();
        let mut broken = frame(1);
        match fault {
            0 => drop(broken[4].remove(2)),
            1 => broken[4][2].truncate(100),
            _ => drop(broken[9].remove(8)),
        }
        let mut found = push_all(&mut depth, broken.iter().flatten());
        found.extend(push_all(&mut depth, frame(2).iter().flatten()));
        assert_eq!(found.len(), 1, "fault {fault}");
        assert_whole(&found[0], 2);
        assert_eq!(depth.dropped(), 1);
        assert!(depth.skipped_bytes() > 0);
    }
}

#[test]
fn a_lost_packet_that_the_controller_reports_is_not_filled_by_a_doubled_one() {
    let mut depth = DepthPackets::default();
    let mut found = Vec::new();
    for (index, images) in frame(1).iter().enumerate() {
        for (number, packet) in images.iter().enumerate() {
            if (index, number) == (3, 5) {
                depth.lose();
                found.extend(push_all(&mut depth, [&images[4], &images[4]]));
            } else {
                found.extend(depth.push(packet));
            }
        }
    }
    assert!(found.is_empty(), "an image of the right length with wrong bytes would be worse than none");
    assert_eq!(push_all(&mut depth, frame(2).iter().flatten()).len(), 1);
}

#[test]
fn a_doubled_packet_costs_its_image_and_a_doubled_image_nothing() {
    let mut depth = DepthPackets::default();
    let mut doubled = frame(1);
    let packet = doubled[2][1].clone();
    doubled[2].insert(1, packet);
    assert!(push_all(&mut depth, doubled.iter().flatten()).is_empty());
    let mut images = frame(2);
    images.insert(5, images[4].clone());
    images.push(images[10].clone());
    let found = push_all(&mut depth, images.iter().flatten());
    assert_eq!((found.len(), depth.dropped(), depth.repeated()), (1, 1, 1));
    assert_whole(&found[0], 2);
}

#[test]
fn images_in_another_order_become_the_same_frame() {
    let mut depth = DepthPackets::default();
    let mut images = frame(1);
    images.swap(0, 9);
    images.swap(3, 4);
    let found = push_all(&mut depth, images.iter().flatten());
    assert_eq!(found.len(), 1);
    assert_whole(&found[0], 1);
}

#[test]
fn a_stream_that_is_joined_in_the_middle_is_synchronised() {
    let mut depth = DepthPackets::default();
    let (first, second) = (frame(1), frame(2));
    let packets = first.iter().flatten().skip(37).chain(second.iter().flatten());
    let found = push_all(&mut depth, packets);
    assert_eq!(found.len(), 1);
    assert_whole(&found[0], 2);
}

#[test]
fn footers_with_senseless_numbers_make_no_frame() {
    let mut depth = DepthPackets::default();
    for (subsequence, length) in
        [(10, IMAGE_BYTES as u32), (u32::MAX, IMAGE_BYTES as u32), (0, 7), (0, u32::MAX)]
    {
        let mut bytes = vec![0; IMAGE_BYTES];
        bytes.extend(words(&[0, 9, 1, 1, subsequence, length]));
        bytes.extend([0; 128]);
        assert!(depth.push(&bytes).is_none());
    }
    assert_eq!(depth.dropped(), 0);
    assert_eq!(depth.skipped_bytes(), 4 * (IMAGE_BYTES as u64 + 152));
    assert!(depth.push(&vec![0; 3 * IMAGE_BYTES]).is_none(), "longer than any image");
    assert_eq!(push_all(&mut depth, frame(5).iter().flatten()).len(), 1);
}

/// A colour packet: header, JPEG file, padding, filler, footer.
fn color(sequence: u32, jpeg: &[u8], padding: usize, filler: usize) -> Vec<u8> {
    let mut bytes = words(&[sequence, HEADER_MAGIC]);
    bytes.extend(jpeg);
    bytes.extend(vec![0xa5; padding]);
    bytes.extend(vec![b'Z'; filler]);
    let length = (bytes.len() + FOOTER_BYTES) as u32;
    bytes.extend(words(&[
        FOOTER_MAGIC,
        sequence,
        filler as u32,
        0,
        0,
        sequence * 267,
        0,
        0,
        HEADER_MAGIC,
        length,
    ]));
    bytes.extend([0; 16]);
    bytes
}

fn jpeg(length: usize) -> Vec<u8> {
    let mut jpeg = vec![0x11; length];
    jpeg[..2].copy_from_slice(&[0xff, 0xd8]);
    jpeg[length - 2..].copy_from_slice(&[0xff, 0xd9]);
    jpeg
}

fn push_color(color: &mut ColorPackets, bytes: &[u8]) -> Vec<ColorPacket> {
    bytes.chunks(TRANSFER_BYTES).filter_map(|transfer| color.push(transfer)).collect()
}

#[test]
fn transfers_become_jpeg_files_without_padding_and_filler() {
    let mut finder = ColorPackets::default();
    for (sequence, padding) in (1..5).zip(0..4) {
        let found = push_color(&mut finder, &color(sequence, &jpeg(60_000), padding, 977));
        let [image] = found.as_slice() else { panic!("{} images", found.len()) };
        assert_eq!((image.sequence, &image.jpeg), (sequence, &jpeg(60_000)));
        assert_eq!(image.stamp.nanos, i64::from(sequence) * 267 * 125_000);
    }
    assert_eq!(finder.skipped_bytes(), 0);
}

#[test]
fn a_packet_with_a_lost_doubled_or_swapped_transfer_is_skipped() {
    let good = |sequence| color(sequence, &jpeg(100_000), 0, 0);
    let whole = good(1);
    let transfers: Vec<&[u8]> = whole.chunks(TRANSFER_BYTES).collect();
    let lost: Vec<&[u8]> = [&transfers[..2], &transfers[3..]].concat();
    let first_lost = transfers[1..].to_vec();
    let last_lost = transfers[..transfers.len() - 1].to_vec();
    let mut swapped = transfers.clone();
    swapped.swap(0, 1);
    let doubled_first: Vec<&[u8]> = [&transfers[..1], &transfers[..]].concat();
    for (name, faulty, expected) in [
        ("lost", lost, vec![2]),
        ("first lost", first_lost, vec![2]),
        ("last lost", last_lost, vec![2]),
        ("swapped", swapped, vec![2]),
        ("first doubled", doubled_first, vec![1, 2]),
    ] {
        let mut finder = ColorPackets::default();
        let mut found: Vec<ColorPacket> = faulty.into_iter().filter_map(|bytes| finder.push(bytes)).collect();
        found.extend(push_color(&mut finder, &good(2)));
        let sequences: Vec<u32> = found.iter().map(|image| image.sequence).collect();
        assert_eq!(sequences, expected, "{name}");
        assert!(
            finder.skipped_bytes() > 0 && found.iter().all(|image| image.jpeg == jpeg(100_000)),
            "{name}"
        );
    }
}

#[test]
fn a_doubled_image_is_passed_over() {
    let mut finder = ColorPackets::default();
    let bytes = color(1, &jpeg(100), 0, 0);
    let count = [&bytes, &bytes].into_iter().filter_map(|bytes| finder.push(bytes)).count();
    assert_eq!((count, finder.skipped_bytes()), (1, bytes.len() as u64));
}

#[test]
fn packets_with_senseless_numbers_make_no_image() {
    let good = color(1, &jpeg(100), 0, 0);
    let footer = good.len() - FOOTER_BYTES;
    let change = |at: usize, value: u32| {
        let mut bytes = good.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let cases = [
        ("length 0", change(footer + 36, 0)),
        ("length of the footer", change(footer + 36, FOOTER_BYTES as u32)),
        ("length beyond the bytes", change(footer + 36, u32::MAX)),
        ("filler beyond the bytes", change(footer + 8, u32::MAX)),
        ("another sequence", change(0, 2)),
        ("no end of the file", change(footer - 4, 0)),
        ("no start of the file", change(HEADER_BYTES, 0)),
    ];
    for (name, bytes) in cases {
        let mut finder = ColorPackets::default();
        assert!(finder.push(&bytes).is_none(), "{name}");
        assert_eq!(finder.skipped_bytes(), bytes.len() as u64, "{name}");
        assert!(finder.push(&good).is_some(), "{name}: the next one is found");
    }
}

#[test]
fn bytes_without_a_footer_are_not_kept() {
    let mut finder = ColorPackets::default();
    for _ in 0..1000 {
        assert!(finder.push(&vec![0xff; TRANSFER_BYTES]).is_none());
    }
    assert!(finder.skipped_bytes() >= (1000 * TRANSFER_BYTES - MAX_PACKET_BYTES) as u64);
    assert!(finder.push(&vec![0; MAX_PACKET_BYTES + 1]).is_none());
    assert!(finder.push(&color(1, &jpeg(100), 0, 0)).is_some());
}
