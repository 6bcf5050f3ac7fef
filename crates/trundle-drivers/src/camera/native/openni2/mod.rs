//! Xtion and the first Astra through OpenNI2.
//!
//! Tested with the dummy device of version 2.2.0.33. It was not tested with a real camera. Recordings (`.oni`) are refused: this version
//! delivers no frame from a recording of its dummy device. The library opens a recording under any file name, so the driver asks it for the
//! kind of each device.
//!
//! The library reports an unplugged camera as silence.
//!
//! | module | content |
//! |---|---|
//! | [`camera`] | the camera and its settings |
//! | [`serve`] | the camera in a separate process |
//! | [`functions`] | the functions of the library |
//! | `session` | open device and streams |

pub mod camera;
pub mod functions;
pub mod serve;
mod session;

pub use camera::{OpenNiCamera, OpenNiSettings};
pub use functions::{LIBRARY, OpenNiApi};
pub use serve::serve_openni;
pub use session::list_devices;
