//! Size of isochronous packets from a configuration descriptor. Source: USB 3.1 specification, 9.6.

/// Types of descriptors. Source: USB 3.1 specification, 9.4, descriptor types.
const INTERFACE_TYPE: u8 = 4;
const ENDPOINT_TYPE: u8 = 5;
const COMPANION_TYPE: u8 = 48;
/// Types of transfer of an endpoint: isochronous. Source: USB 3.1 specification, 9.6.6.
const ISOCHRONOUS_BITS: u8 = 1;
/// Bits of the type of transfer. Source: USB 3.1 specification, 9.6.6.
const TRANSFER_MASK: u8 = 3;

/// Bytes per interval of the isochronous `endpoint` of the `interface` in its `alternate` setting, from its SuperSpeed companion. `None`
/// without such an endpoint or companion: the device is at a port that is too slow.
pub fn bytes_per_interval(configuration: &[u8], interface: u8, alternate: u8, endpoint: u8) -> Option<usize> {
    let (mut is_setting, mut is_endpoint) = (false, false);
    let mut rest = configuration;
    while let [length, kind, ..] = *rest {
        let (descriptor, following) = rest.split_at_checked(length.into()).filter(|_| length >= 2)?;
        match (kind, descriptor) {
            (INTERFACE_TYPE, [_, _, number, setting, ..]) => {
                (is_setting, is_endpoint) = ((*number, *setting) == (interface, alternate), false);
            }
            (ENDPOINT_TYPE, [_, _, address, attributes, ..]) => {
                is_endpoint =
                    is_setting && *address == endpoint && attributes & TRANSFER_MASK == ISOCHRONOUS_BITS;
            }
            (COMPANION_TYPE, [_, _, _, _, low, high, ..]) if is_endpoint => {
                return Some(u16::from_le_bytes([*low, *high]).into());
            }
            _ => {}
        }
        rest = following;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn configuration() -> Vec<u8> {
        let setting = |alternate: u8| [9, 4, 1, alternate, alternate, 0xff, 0, 0, 0];
        let mut bytes = vec![9, 2, 0, 0, 2, 1, 0, 0x80, 50];
        bytes.extend([9, 4, 0, 0, 1, 0xff, 0, 0, 0, 7, 5, 0x81, 2, 0, 4, 0, 6, 48, 0, 0, 0, 0]);
        bytes.extend(setting(0));
        bytes.extend(setting(1));
        bytes.extend([7, 5, 0x84, 1, 0, 4, 1, 6, 48, 15, 2, 0x00, 0x84]);
        bytes
    }

    #[test]
    fn the_companion_of_the_endpoint_tells_the_size() {
        let bytes = configuration();
        assert_eq!(bytes_per_interval(&bytes, 1, 1, 0x84), Some(0x8400));
        assert_eq!(bytes_per_interval(&bytes, 1, 0, 0x84), None);
        assert_eq!(bytes_per_interval(&bytes, 0, 0, 0x81), None, "a bulk endpoint");
    }

    #[test]
    fn a_cut_or_senseless_configuration_has_no_size() {
        let bytes = configuration();
        for end in 0..bytes.len() {
            assert_eq!(bytes_per_interval(&bytes[..end], 1, 1, 0x84), None, "{end}");
        }
        assert_eq!(bytes_per_interval(&[0; 64], 1, 1, 0x84), None);
    }
}
