//! Tests of the decoder: cuts, garbage, and every fault of one byte.

use super::*;
use crate::kobuki::protocol::{CoreSensors, RawGyro};
use proptest::prelude::*;

/// The packet of a real base.
fn captured() -> Vec<u8> {
    let text = include_str!("../../../tests/data/feedback_packet.hex");
    text.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect()
}

/// A packet that differs in many bytes from those of other stamps.
fn packet(stamp_ms: u16) -> Vec<u8> {
    let ticks = stamp_ms.wrapping_mul(7919);
    let core = CoreSensors { stamp_ms, left_ticks: ticks, right_ticks: !ticks, ..CoreSensors::default() };
    let gyro = RawGyro { frame_id: stamp_ms as u8, readings: vec![[1, -2, ticks as i16]; 2] };
    Feedback { core: Some(core), gyro: Some(gyro), ..Feedback::default() }.encode()
}

fn stamps(bytes: &[u8]) -> (Vec<u16>, DecoderCounters) {
    let (mut decoder, mut stamps) = (FeedbackDecoder::default(), Vec::new());
    decoder.push(bytes, |feedback| stamps.extend(feedback.core.map(|core| core.stamp_ms)));
    (stamps, decoder.counters())
}

#[test]
fn the_captured_packet_has_its_values() {
    let mut packets = Vec::new();
    FeedbackDecoder::default().push(&captured(), |feedback| packets.push(feedback));
    let [feedback] = packets.try_into().unwrap();
    let core = feedback.core.unwrap();
    assert_eq!((core.stamp_ms, core.left_ticks, core.right_ticks), (2984, 65_532, 62_447));
    assert!(!core.bumper.any() && !core.wheel_drop.any() && !core.cliff.any());
    assert!((core.battery_v() - 15.7).abs() < 1e-12);
    let inertia = feedback.inertia.unwrap();
    assert!((inertia.angle().to_degrees() + 62.45).abs() < 1e-9 && inertia.rate() == 0.0);
    let cliff = feedback.cliff.unwrap();
    assert_eq!([cliff.right, cliff.center, cliff.left], [1673, 1965, 1609]);
    let gyro = feedback.gyro.unwrap();
    assert_eq!((gyro.frame_id, gyro.readings), (0xEE, vec![[42, -110, -68], [35, -104, -71]]));
    assert_eq!(feedback.inputs.unwrap().analog, [0x0FFF, 0x0FFF, 0x0FFF, 0x0FFF]);
    assert_eq!(feedback.dock, Some(Default::default()));
}

#[test]
fn the_captured_packet_is_encoded_to_its_bytes_but_for_unused_ones() {
    let mut packets = Vec::new();
    FeedbackDecoder::default().push(&captured(), |feedback| packets.push(feedback));
    let bytes = packets[0].encode();
    let differing: Vec<usize> = (0..81).filter(|i| bytes[*i] != captured()[*i]).collect();
    assert_eq!((bytes.len(), differing), (81, vec![74, 75, 80]), "unused word of the inputs, and checksum");
}

#[test]
fn the_usual_field_fault_costs_no_packet() {
    let bytes =
        [&[0x2D], &captured()[..], &[0xAA], &captured(), &[0xAA, 0x55, 0x4D, 0x01], &captured()].concat();
    let (found, counters) = stamps(&bytes);
    assert_eq!(found, [2984; 3]);
    assert_eq!((counters.packets, counters.skipped_bytes, counters.wrong_length), (3, 6, 1));
}

#[test]
fn a_packet_inside_refused_bytes_is_found() {
    let inner = packet(4000);
    let mut outer = vec![0xAA, 0x55, inner.len() as u8 + 2, 200, inner.len() as u8];
    outer.extend(&inner);
    outer.push(0x77);
    let (found, counters) = stamps(&outer);
    assert_eq!((found, counters.wrong_checksum, counters.skipped_bytes), (vec![4000], 1, 6));
}

#[test]
fn a_checksum_that_is_the_header_s_first_byte_is_used_for_both() {
    let stamp = (0..=u16::MAX).find(|stamp| packet(*stamp).last() == Some(&0xAA)).unwrap();
    let (good, next) = (packet(stamp), packet(stamp.wrapping_add(20)));
    let both = [stamp, stamp.wrapping_add(20)];
    assert_eq!(stamps(&[&good[..], &next].concat()).0, both);
    let (found, counters) = stamps(&[&good[..], &next[1..]].concat());
    assert_eq!((&found[..], counters.skipped_bytes), (&both[..], 0));
    assert_eq!(stamps(&[&good[..], &[7, 7], &next].concat()).1.skipped_bytes, 2);
}

#[test]
fn a_new_stream_does_not_end_a_packet_of_the_old_one() {
    let (first, second) = (&captured()[..40], &captured()[40..]);
    let (mut decoder, mut packets) = (FeedbackDecoder::default(), 0);
    decoder.push(first, |_| packets += 1);
    decoder.clear();
    decoder.push(second, |_| packets += 1);
    assert_eq!((packets, decoder.counters().skipped_bytes), (0, 81));
}

/// Every fault of one byte, at every place: the packets around it must be found.
#[test]
fn a_fault_of_one_byte_costs_only_the_packet_it_touches() {
    let around = [packet(1000), packet(1020), captured(), packet(1060), packet(1080)];
    let start = around[0].len() + around[1].len();
    // A false length of 255 is known to be wrong only 259 bytes later.
    let after: Vec<u8> = (0..8).flat_map(|i| packet(2000 + 20 * i)).collect();
    let (stream, length) = ([around.concat(), after].concat(), captured().len());
    let check = |damaged: &[u8], fault: &str| {
        let found = stamps(damaged).0;
        let expected = [1000, 1020, 1060, 1080];
        assert!(expected.iter().all(|stamp| found.contains(stamp)), "{fault}: {found:?}");
    };
    for at in start..start + length {
        check(&[&stream[..at], &stream[at + 1..]].concat(), &format!("lost {at}"));
        check(&[&stream[..=at], &stream[at..]].concat(), &format!("doubled {at}"));
        for flip in 1..=255 {
            let mut damaged = stream.clone();
            damaged[at] ^= flip;
            check(&damaged, &format!("flipped {at} by {flip}"));
        }
    }
}

#[test]
fn a_flipped_byte_is_never_taken_for_a_packet() {
    for at in 0..captured().len() {
        for flip in 1..=255 {
            let mut damaged = captured();
            damaged[at] ^= flip;
            assert_eq!(stamps(&damaged).0, [0; 0], "byte {at}, {flip}");
        }
    }
}

#[test]
fn ten_million_random_bytes_go_through() {
    let (mut decoder, mut state, mut packets) = (FeedbackDecoder::default(), 1u64, 0);
    let mut chunk = vec![0; 10_000];
    for _ in 0..1000 {
        for byte in &mut chunk {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            *byte = (state >> 56) as u8;
        }
        decoder.push(&chunk, |_| packets += 1);
        assert!(decoder.0.buffer.len() < MAX_FRAME_BYTES && decoder.0.buffer.capacity() == MAX_FRAME_BYTES);
    }
    let counters = decoder.counters();
    assert!(counters.skipped_bytes > 9_900_000 && counters.packets == packets, "{counters:?}");
    assert!(counters.refused() > 100, "{counters:?}: headers occur in random bytes");
}

#[test]
fn headers_without_end_go_through() {
    for pattern in [&[0xAA, 0x55][..], &[0xAA, 0x55, 0xFF], &[0xAA], &[0xAA, 0x55, 0xFF, 0xC8, 0x00]] {
        fuzz_decoder(&pattern.repeat(20_000));
    }
}

fn pieces() -> impl Strategy<Value = Vec<Vec<u8>>> {
    let garbage = prop::collection::vec(any::<u8>(), 0..40);
    let headers = prop::collection::vec(prop::sample::select(vec![0xAAu8, 0x55, 3, 77, 255]), 0..40);
    prop::collection::vec(prop_oneof![garbage, headers, any::<u16>().prop_map(packet)], 0..12)
}

proptest! {
    #[test]
    fn a_cut_changes_nothing(pieces in pieces()) {
        fuzz_decoder(&pieces.concat());
    }

    #[test]
    fn any_chunks_give_the_same(pieces in pieces(), cuts in prop::collection::vec(1usize..120, 1..30)) {
        let bytes = pieces.concat();
        let (mut decoder, mut found, mut rest) = (FeedbackDecoder::default(), Vec::new(), &bytes[..]);
        for cut in cuts.iter().cycle() {
            let (chunk, after) = rest.split_at((*cut).min(rest.len()));
            decoder.push(chunk, |feedback| found.extend(feedback.core.map(|core| core.stamp_ms)));
            rest = after;
            if rest.is_empty() { break; }
        }
        prop_assert_eq!((found, decoder.counters()), stamps(&bytes));
    }

    /// Garbage without a header's first byte cannot hide a packet.
    #[test]
    fn packets_between_garbage_are_all_found(
        parts in prop::collection::vec((prop::collection::vec(0u8..0xAA, 0..60), any::<u16>()), 1..10),
    ) {
        let bytes: Vec<u8> = parts.iter().flat_map(|(garbage, stamp)| [garbage.clone(), packet(*stamp)].concat()).collect();
        let garbage: usize = parts.iter().map(|(garbage, _)| garbage.len()).sum();
        let (found, counters) = stamps(&bytes);
        prop_assert_eq!(found, parts.iter().map(|(_, stamp)| *stamp).collect::<Vec<_>>());
        prop_assert_eq!(counters.skipped_bytes, garbage as u64);
    }
}
