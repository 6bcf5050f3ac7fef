//! Settings of a map's features: camera and extractor. A map is loaded only with the settings it was saved with.

use crate::persist::bytes::{Reader, Writer};
use crate::persist::error::MapFileError;
use trundle_core::PinholeCamera;
use trundle_vision::OrbConfig;

/// Name and value of each setting; whole numbers are exact as f64.
fn settings(camera: &PinholeCamera, orb: &OrbConfig) -> [(&'static str, f64); 18] {
    let lens = camera.distortion();
    [
        ("camera width (px)", camera.width() as f64),
        ("camera height (px)", camera.height() as f64),
        ("camera fx (px)", camera.fx()),
        ("camera fy (px)", camera.fy()),
        ("camera cx (px)", camera.cx()),
        ("camera cy (px)", camera.cy()),
        ("camera distortion k1", lens.k1),
        ("camera distortion k2", lens.k2),
        ("camera distortion p1", lens.p1),
        ("camera distortion p2", lens.p2),
        ("camera distortion k3", lens.k3),
        ("orb.features", orb.features as f64),
        ("orb.levels", orb.levels as f64),
        ("orb.scale_factor", orb.scale_factor),
        ("orb.fast_threshold (grey values)", f64::from(orb.fast_threshold)),
        ("orb.fast_min_threshold (grey values)", f64::from(orb.fast_min_threshold)),
        ("orb.cell_px", orb.cell_px as f64),
        ("orb.min_texture", orb.min_texture),
    ]
}

pub(crate) fn write(out: &mut Writer, camera: &PinholeCamera, orb: &OrbConfig) {
    out.f64s(settings(camera, orb).map(|(_, value)| value));
}

/// Reads the settings of a map and compares them with these.
pub(crate) fn check(bytes: &mut Reader, camera: &PinholeCamera, orb: &OrbConfig) -> Result<(), MapFileError> {
    for (name, given) in settings(camera, orb) {
        let saved = bytes.f64()?;
        if saved != given {
            return Err(MapFileError::Mismatch { name, saved: saved.to_string(), given: given.to_string() });
        }
    }
    Ok(())
}
