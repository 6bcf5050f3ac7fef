//! Stored scans as bytes: any scan comes back, and broken ones are refused by the name of the part.

use super::*;
use proptest::prelude::*;

fn any_scan() -> impl Strategy<Value = StoredScan> {
    let ray = (any::<i16>(), any::<i16>(), any::<u8>()).prop_map(|(x, y, what)| PackedRay { x, y, what });
    let rays = prop::collection::vec(ray, 1..40);
    let spans = prop::collection::vec((any::<prop::sample::Index>(), any::<u16>(), any::<u16>()), 0..20);
    (rays, spans, any::<bool>(), -100.0..100.0_f32, -100.0..100.0_f32).prop_map(
        |(rays, spans, has_sigmas, x, y)| {
            let mut spans: Vec<PackedSpan> = spans
                .iter()
                .map(|(ray, from, to)| PackedSpan { ray: ray.index(rays.len()) as u32, from: *from, to: *to })
                .collect();
            spans.sort_by_key(|span| span.ray);
            let sigmas: Vec<u8> =
                if has_sigmas { rays.iter().map(|ray| ray.what / 3).collect() } else { Vec::new() };
            StoredScan { origin: (x, y), rays: rays.into(), sigmas: sigmas.into(), spans: spans.into() }
        },
    )
}

fn written(scan: &StoredScan) -> Vec<u8> {
    let mut out = Writer::default();
    write(&mut out, scan);
    out.0
}

fn refusal(scan: &StoredScan) -> FilterFileError {
    read(&mut Reader::new(&written(scan), "scans")).unwrap_err()
}

proptest! {
    #[test]
    fn a_stored_scan_comes_back_and_a_cut_one_does_not(scan in any_scan(), at: prop::sample::Index) {
        let bytes = written(&scan);
        let mut reader = Reader::new(&bytes, "scans");
        prop_assert_eq!(read(&mut reader).unwrap(), scan);
        prop_assert!(reader.end().is_ok(), "all bytes are read");
        let cut = read(&mut Reader::new(&bytes[..at.index(bytes.len())], "scans"));
        prop_assert_eq!(cut.unwrap_err(), FilterFileError::Cut { within: "scans" });
    }

    /// Two scans in a row do not run into each other.
    #[test]
    fn scans_in_a_row_come_back_one_by_one(one in any_scan(), other in any_scan()) {
        let bytes = [written(&one), written(&other)].concat();
        let mut reader = Reader::new(&bytes, "scans");
        prop_assert_eq!(read(&mut reader).unwrap(), one);
        prop_assert_eq!(read(&mut reader).unwrap(), other);
    }
}

#[test]
fn a_scan_that_contradicts_itself_is_refused_by_the_part() {
    let ray = PackedRay { x: 1, y: -2, what: 1 };
    let span = |ray| PackedSpan { ray, from: 3, to: 4 };
    let scan = |origin, sigmas: &[u8], spans: &[PackedSpan]| StoredScan {
        origin,
        rays: vec![ray; 3].into(),
        sigmas: sigmas.into(),
        spans: spans.into(),
    };
    let here = (0.0, 0.0);
    for (broken, what) in [
        (scan((f32::NAN, 0.0), &[], &[]), "the origin of a scan"),
        (scan((0.0, f32::INFINITY), &[], &[]), "the origin of a scan"),
        (scan(here, &[1, 2], &[]), "the sigmas of a scan"),
        (scan(here, &[], &[span(3)]), "the ray of a free stretch"),
        (scan(here, &[], &[span(2), span(1)]), "the ray of a free stretch"),
    ] {
        assert_eq!(refusal(&broken), FilterFileError::Content { what });
    }
}
