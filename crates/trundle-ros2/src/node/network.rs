//! Networks that a node uses.

use std::net::{IpAddr, Ipv4Addr};
use std::str::FromStr;

/// Networks that a node uses. DDS has no authentication: every computer on such a network may read every topic and drive the robot.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Networks {
    /// This computer alone.
    #[default]
    Loopback,
    /// The interfaces with these addresses.
    Only(Vec<IpAddr>),
    /// Every interface.
    All,
}

/// What programs of ROS 2 on this computer need so that they find a node on the loopback interface alone.
pub(crate) const DISCOVERY: &str =
    "ROS 2 programs on this computer need `export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`";

impl Networks {
    /// What other programs need to find a node on this computer alone; `None` on other networks.
    #[must_use]
    pub fn discovery_hint(&self) -> Option<&'static str> {
        (*self == Self::Loopback).then_some(DISCOVERY)
    }

    /// Addresses of the interfaces; `None` for all.
    pub(super) fn addresses(&self) -> Option<Vec<IpAddr>> {
        match self {
            Self::Loopback => Some(vec![IpAddr::V4(Ipv4Addr::LOCALHOST)]),
            Self::Only(addresses) => Some(addresses.clone()),
            Self::All => None,
        }
    }

    /// Abilities of others on the network; `None` on this computer alone.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let danger = "everyone there can read the camera and drive the robot: DDS has no password (docs/how-to/ros2.md, Security)";
        match self {
            Self::Loopback => None,
            Self::Only(addresses) => {
                let addresses: Vec<String> = addresses.iter().map(ToString::to_string).collect();
                Some(format!("ROS 2 is open on the network of {}: {danger}", addresses.join(", ")))
            }
            Self::All => Some(format!("ROS 2 is open on every network of this computer: {danger}")),
        }
    }
}

/// `loopback`, `all`, or addresses parted by commas.
impl FromStr for Networks {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "loopback" | "lo" => Ok(Self::Loopback),
            "all" => Ok(Self::All),
            addresses => {
                let address = |part: &str| {
                    part.trim().parse().map_err(|_| {
                        format!("'{part}' is not a network; expected loopback, all, or the IP address of an interface")
                    })
                };
                Ok(Self::Only(addresses.split(',').map(address).collect::<Result<_, _>>()?))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_loopback_is_without_warning() {
        let loopback: Networks = "loopback".parse().unwrap();
        assert_eq!(loopback.warning(), None);
        assert!(loopback.discovery_hint().unwrap().contains("ROS_AUTOMATIC_DISCOVERY_RANGE"));
        assert_eq!(Networks::All.discovery_hint(), None);
        let lan: Networks = "192.168.1.5".parse().unwrap();
        assert!(lan.warning().unwrap().contains("192.168.1.5"));
        assert_eq!(Networks::All.addresses(), None);
        assert!("wlan0".parse::<Networks>().unwrap_err().contains("'wlan0'"));
    }
}
