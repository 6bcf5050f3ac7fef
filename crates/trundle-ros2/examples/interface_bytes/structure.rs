//! A structure of the table: its name, and its values as bytes and as JSON.

use super::filler::Filler;
use ros2_client::Message;
use ros2_client::action::{
    FeedbackMessage, GetResultRequest, GetResultResponse, SendGoalRequest, SendGoalResponse,
};
use ros2_client::dds::rustdds::RepresentationIdentifier;
use ros2_client::dds::rustdds::serialization::{deserialize_from_cdr_with_rep_id, to_writer_with_rep_id};
use trundle_ros2::interface::{ActionType, MessageType, ServiceType};

/// Bytes before a message: little-endian CDR without options. Source: DDSI-RTPS, 10.2.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];

/// A structure of the table.
pub struct Structure {
    /// Its name in Python: `std_srvs/srv/Trigger_Request`.
    pub name: String,
    /// The structure filled with distinct values.
    pub filled: fn() -> Result<Encoded, String>,
    /// The structure with the values in these bytes.
    pub decoded: fn(&[u8]) -> Result<Encoded, String>,
}

/// A structure's values.
pub struct Encoded {
    /// CDR with its encapsulation.
    pub bytes: Vec<u8>,
    /// Each field by its name.
    pub fields: serde_json::Value,
}

impl Structure {
    fn of<T: Message>(name: String) -> Self {
        Self { name, filled: filled::<T>, decoded: decoded::<T> }
    }
}

/// The structure of a message.
pub fn message<M: MessageType>() -> Vec<Structure> {
    vec![Structure::of::<M>(format!("{}/msg/{}", M::PACKAGE, M::NAME))]
}

/// The structures of a service.
pub fn service<S: ServiceType>() -> Vec<Structure> {
    let name = format!("{}/srv/{}", S::PACKAGE, S::NAME);
    vec![
        Structure::of::<S::Request>(format!("{name}_Request")),
        Structure::of::<S::Response>(format!("{name}_Response")),
    ]
}

/// The structures of an action, with those of its services and of its feedback topic.
pub fn action<A: ActionType>() -> Vec<Structure> {
    let name = format!("{}/action/{}", A::PACKAGE, A::NAME);
    vec![
        Structure::of::<A::Goal>(format!("{name}_Goal")),
        Structure::of::<A::Result>(format!("{name}_Result")),
        Structure::of::<A::Feedback>(format!("{name}_Feedback")),
        Structure::of::<SendGoalRequest<A::Goal>>(format!("{name}_SendGoal_Request")),
        Structure::of::<SendGoalResponse>(format!("{name}_SendGoal_Response")),
        Structure::of::<GetResultRequest>(format!("{name}_GetResult_Request")),
        Structure::of::<GetResultResponse<A::Result>>(format!("{name}_GetResult_Response")),
        Structure::of::<FeedbackMessage<A::Feedback>>(format!("{name}_FeedbackMessage")),
    ]
}

fn filled<T: Message>() -> Result<Encoded, String> {
    let value = T::deserialize(&mut Filler::default()).map_err(|e| e.to_string())?;
    encoded(&value)
}

fn decoded<T: Message>(bytes: &[u8]) -> Result<Encoded, String> {
    let body = bytes.strip_prefix(&ENCAPSULATION).ok_or("the bytes do not begin with 00010000")?;
    let read = deserialize_from_cdr_with_rep_id::<T>(body, RepresentationIdentifier::CDR_LE);
    let (value, length) = read.map_err(|e| format!("{e:?}"))?;
    // rclpy's size of a message with empty sequences of 8-byte numbers counts padding that is not there: its bytes end with a rest.
    if length > body.len() {
        return Err(format!("{length} bytes were read, {} follow the encapsulation", body.len()));
    }
    encoded(&value)
}

fn encoded<T: Message>(value: &T) -> Result<Encoded, String> {
    let mut bytes = ENCAPSULATION.to_vec();
    to_writer_with_rep_id(&mut bytes, value, RepresentationIdentifier::CDR_LE)
        .map_err(|e| format!("{e:?}"))?;
    let fields = serde_json::to_value(value).map_err(|e| e.to_string())?;
    Ok(Encoded { bytes, fields })
}
