//! The robot's settings as ROS 2 parameters: each can be read, with its meaning and range. None changes while the robot runs.

use crate::Ros2Error;
use crate::generated::rcl_interfaces::{
    DescribeParameters, DescribeParametersResponse, GetParameterTypes, GetParameterTypesResponse,
    GetParameters, GetParametersResponse, ListParameters, ListParametersRequest, ListParametersResponse,
    ListParametersResult, ParameterDescriptor, ParameterType, ParameterValue, SetParameters,
    SetParametersAtomically, SetParametersAtomicallyResponse, SetParametersResponse, SetParametersResult,
};
use crate::node::RosNode;
use crate::wire::Bytes;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_runtime::RobotConfig;
use trundle_runtime::settings::reference;

/// Why a parameter is not set.
const READ_ONLY: &str =
    "settings of a running robot cannot change: set them in the robot file and start trundle anew";

/// A parameter.
#[derive(Debug, Clone)]
struct Parameter {
    value: ParameterValue,
    description: String,
    constraints: String,
}

/// All parameters by name.
#[derive(Debug, Clone)]
pub struct Parameters(Arc<BTreeMap<String, Parameter>>);

impl Parameters {
    /// The settings of a robot, and `use_sim_time`.
    #[must_use]
    pub fn of(robot: &RobotConfig, use_sim_time: bool) -> Self {
        let root = serde_json::to_value(robot).unwrap_or_default();
        let parameter = |setting: &trundle_runtime::settings::Setting| {
            let value = value_of(root.pointer(&format!("/{}", setting.path.replace('.', "/")))?);
            let constraints = if setting.kind.contains('|') {
                format!("one of {}", setting.kind.replace('|', ", "))
            } else {
                String::new()
            };
            Some((
                setting.key.to_owned(),
                Parameter { value, description: setting.doc.to_owned(), constraints },
            ))
        };
        let mut parameters: BTreeMap<String, Parameter> = reference().iter().filter_map(parameter).collect();
        let sim_time = Parameter {
            value: value_of(&Value::Bool(use_sim_time)),
            description: "Whether /clock gives the time.".to_owned(),
            constraints: String::new(),
        };
        parameters.insert("use_sim_time".to_owned(), sim_time);
        Self(Arc::new(parameters))
    }

    fn value(&self, name: &str) -> ParameterValue {
        self.0.get(name).map(|parameter| parameter.value.clone()).unwrap_or_default()
    }

    fn describe(&self, name: &str) -> ParameterDescriptor {
        let own = self.0.get(name);
        ParameterDescriptor {
            name: name.to_owned(),
            r#type: own.map_or(ParameterType::PARAMETER_NOT_SET, |parameter| parameter.value.r#type),
            description: own.map(|parameter| parameter.description.clone()).unwrap_or_default(),
            additional_constraints: own.map(|parameter| parameter.constraints.clone()).unwrap_or_default(),
            read_only: true,
            ..ParameterDescriptor::default()
        }
    }

    fn list(&self, request: &ListParametersRequest) -> ListParametersResult {
        let has_depth = |rest: &str| request.depth == 0 || rest.split('.').count() as u64 <= request.depth;
        let is_asked = |name: &str| {
            let below = |prefix: &String| {
                name == prefix
                    || name
                        .strip_prefix(prefix.as_str())
                        .is_some_and(|rest| rest.starts_with('.') && has_depth(&rest[1..]))
            };
            if request.prefixes.is_empty() { has_depth(name) } else { request.prefixes.iter().any(below) }
        };
        let names: Vec<String> = self.0.keys().filter(|name| is_asked(name)).cloned().collect();
        let mut prefixes: Vec<String> =
            names.iter().filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned())).collect();
        prefixes.dedup();
        ListParametersResult { names, prefixes }
    }

    fn refuse(&self, name: &str) -> SetParametersResult {
        let reason = if self.0.contains_key(name) {
            READ_ONLY.to_owned()
        } else {
            format!("there is no parameter {name}")
        };
        SetParametersResult { successful: false, reason }
    }

    /// Offers the six services of parameters.
    ///
    /// # Errors
    /// When a service cannot be made.
    pub fn offer(&self, node: &mut RosNode) -> Result<(), Ros2Error> {
        let own = self.clone();
        node.serve::<GetParameters>("~/get_parameters", move |request| GetParametersResponse {
            values: request.names.iter().map(|name| own.value(name)).collect(),
        })?;
        let own = self.clone();
        node.serve::<GetParameterTypes>("~/get_parameter_types", move |request| GetParameterTypesResponse {
            types: Bytes(request.names.iter().map(|name| own.value(name).r#type).collect()),
        })?;
        let own = self.clone();
        node.serve::<DescribeParameters>("~/describe_parameters", move |request| {
            DescribeParametersResponse {
                descriptors: request.names.iter().map(|name| own.describe(name)).collect(),
            }
        })?;
        let own = self.clone();
        node.serve::<ListParameters>("~/list_parameters", move |request| ListParametersResponse {
            result: own.list(&request),
        })?;
        let own = self.clone();
        node.serve::<SetParameters>("~/set_parameters", move |request| SetParametersResponse {
            results: request.parameters.iter().map(|parameter| own.refuse(&parameter.name)).collect(),
        })?;
        let own = self.clone();
        node.serve::<SetParametersAtomically>("~/set_parameters_atomically", move |request| {
            let name = request.parameters.first().map(|parameter| parameter.name.clone()).unwrap_or_default();
            SetParametersAtomicallyResponse { result: own.refuse(&name) }
        })
    }
}

/// A value of the settings as a parameter. What has no type of its own is its JSON text.
fn value_of(value: &Value) -> ParameterValue {
    let mut own = ParameterValue::default();
    match value {
        Value::Null => {}
        Value::Bool(flag) => (own.r#type, own.bool_value) = (ParameterType::PARAMETER_BOOL, *flag),
        Value::Number(number) => match number.as_i64() {
            Some(integer) => (own.r#type, own.integer_value) = (ParameterType::PARAMETER_INTEGER, integer),
            None => {
                (own.r#type, own.double_value) =
                    (ParameterType::PARAMETER_DOUBLE, number.as_f64().unwrap_or_default())
            }
        },
        Value::String(text) => {
            (own.r#type, own.string_value) = (ParameterType::PARAMETER_STRING, text.clone())
        }
        Value::Array(_) | Value::Object(_) => {
            (own.r#type, own.string_value) = (ParameterType::PARAMETER_STRING, value.to_string())
        }
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_can_be_read_with_its_meaning_and_none_set() {
        let parameters = Parameters::of(&RobotConfig::default(), true);
        let names = parameters.list(&ListParametersRequest::default()).names;
        assert!(names.len() > 100, "{}", names.len());
        let described = parameters.describe("drive.wheel_radius_m");
        assert!(described.read_only && !described.description.is_empty());
        assert_eq!(described.r#type, ParameterType::PARAMETER_DOUBLE);
        assert_eq!(
            parameters.value("drive.wheel_radius_m").double_value,
            RobotConfig::default().drive.wheel_radius
        );
        assert!(parameters.value("use_sim_time").bool_value);
        assert_eq!(parameters.value("no.such").r#type, ParameterType::PARAMETER_NOT_SET);
        assert!(parameters.refuse("no.such").reason.contains("no.such"));
        let below = parameters.list(&ListParametersRequest { prefixes: vec!["drive".into()], depth: 1 });
        assert!(below.names.iter().all(|name| name.starts_with("drive.")) && !below.names.is_empty());
    }
}
