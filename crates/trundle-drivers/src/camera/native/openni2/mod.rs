//! Xtion and the first Astra through OpenNI2.
//!
//! Tested with the dummy device of version 2.2.0.33 and with a recording of that device. It was not tested with a real camera. This version
//! plays no image of a recording without the cropping of its streams, a property that the dummy device lacks
//! (docs/experiments/openni2-recordings.md). The library opens a recording under any file name, so the driver asks it for the kind of each
//! device.
//!
//! The library reports an unplugged camera as silence.
//!
//! | module | content |
//! |---|---|
//! | [`camera`] | the camera and its settings |
//! | [`serve`] | the camera in a separate process |
//! | [`functions`] | the functions of the library |
//! | `session` | open device and streams |
//! | `playback` | the images of a recording and its end |

pub mod camera;
pub mod functions;
mod playback;
pub mod serve;
mod session;

pub use camera::{OpenNiCamera, OpenNiSettings};
pub use functions::{LIBRARY, OpenNiApi};
pub use serve::serve_openni;
pub use session::list_devices;
