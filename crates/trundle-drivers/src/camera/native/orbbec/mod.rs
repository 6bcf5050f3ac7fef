//! Orbbec cameras (Gemini 330, Femto, Astra 2) through OrbbecSDK 2.
//!
//! Not tested with a device. Loading, version, the empty device list and the errors are tested with version 2.9.3 of the library; streams,
//! intrinsics and stamps follow its documentation.
//!
//! | module | content |
//! |---|---|
//! | [`camera`] | the camera and its settings |
//! | [`intrinsics`] | lens models and poses |
//! | [`functions`] | the functions of the library |
//! | `api` | loading, calls, objects, errors |
//! | `device_list` | connected cameras |
//! | `frames` | frames and the stream data in them |

mod api;
pub mod camera;
mod device_list;
mod frames;
pub mod functions;
pub mod intrinsics;

pub use camera::{OrbbecCamera, OrbbecSettings};
pub use device_list::list_devices;
pub use functions::{LIBRARY, OrbbecApi};
