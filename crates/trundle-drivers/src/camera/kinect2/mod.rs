//! Depth of the Kinect V2 from its raw packets.
//!
//! **Problem.** The Kinect V2 sends no depth. It sends ten images of 11-bit numbers: three shifted measurements for each of three
//! modulation frequencies, and one of ambient light. The host computes depth.
//!
//! **Idea.** Three measurements shifted by a third of a turn give the phase and amplitude of the returning light. The phase is the distance
//! modulo half a wavelength of the modulation. Three frequencies agree at one distance only within 18.75 m, which unwraps the phase. Two
//! filters reduce noise: a bilateral filter on the phasors, and a filter that removes pixels that float between two surfaces.
//!
//! **Cost.** One pass over the pixels for each step; see the figures that the test `kinect2` prints.
//!
//! Sources: \[Lawin16\] (frequencies, shifts, phase and amplitude, unwrapping, noise of the phase); \[Sell14\] (the sensor);
//! \[Tomasi98\] (the bilateral filter); \[Reynolds11\] (flying pixels).
//!
//! | symbol in \[Lawin16\] | name here | unit |
//! |---|---|---|
//! | v_k | measurement | 1 |
//! | p_k | shift: 0, 1/3, 2/3 of a turn | turn |
//! | p_0 | `p0` | 1/65536 turn |
//! | z | phasor | 1 |
//! | a | amplitude | 1 |
//! | phi | phase | turn |
//! | n | wraps | 1 |
//! | d | distance along the ray | m |
//!
//! # Assumptions
//!
//! The bytes are not documented by the manufacturer. The following facts are assumptions that were not verified with a device. All but
//! those of the phase and its unit agree with \[Freenect2\], whose authors have devices. \[Freenect2\] subtracts p_0 where this decoder
//! adds it (`usb` changes the sign), and its unit of `p0` is larger by 1.6 %:
//!
//! | fact | assumption | module |
//! |---|---|---|
//! | order of the bits | the first pixel in the lowest bits, 8 pixels in 11 bytes | [`packing`] |
//! | order of the columns | four interleaved blocks of 128: columns 0, 4, 8, ..., then 1, 5, 9, ... | [`packing`] |
//! | order of the rows | both halves from the middle outwards, the lower half first | [`packing`] |
//! | code of a number | sign and magnitude; the magnitude in segments that double, as in \[G711\] A-law | [`companding`] |
//! | saturated measurement | the code of minus zero | [`companding`] |
//! | order of the images | 80 MHz, 16 MHz, 120 MHz, three shifts each; then ambient | [`layout`] |
//! | sign of the phase | a measurement is a cos(phi + p_0 + p_k) | [`phasors`] |
//! | unit of `p0` | 65536 for one turn | [`phasors`] |
//! | footer of a packet | see [`packets`] | [`packets`] |
//! | unit of the time stamp | 0.125 ms | [`packets`] |

pub mod companding;
mod decoder;
mod dump;
mod dump_camera;
mod edge_filter;
pub mod layout;
pub mod packets;
pub mod packing;
pub mod phasors;
mod smoothing;
mod unwrapping;
pub mod usb;

pub use decoder::{DecoderConfig, DepthDecoder, Kinect2Calibration};
pub use dump::{DumpReader, DumpWriter, parse_dump_header};
pub use dump_camera::DumpCamera;
pub use packets::{FrameAssembler, PackedFrame, SubPacket, SubPacketParser};
