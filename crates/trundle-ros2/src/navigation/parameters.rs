//! The robot's settings as ROS 2 parameters: each can be read, with its meaning. Some change while the robot runs, within a range.

mod listing;

use super::active_goal::ActiveGoal;
use crate::Ros2Error;
use crate::generated::rcl_interfaces::{
    DescribeParameters, DescribeParametersResponse, FloatingPointRange, GetParameterTypes,
    GetParameterTypesResponse, GetParameters, GetParametersResponse, ListParameters, ListParametersRequest,
    ListParametersResponse, ListParametersResult, Parameter as ParameterMessage, ParameterDescriptor,
    ParameterType, ParameterValue, SetParameters, SetParametersAtomically, SetParametersAtomicallyResponse,
    SetParametersResponse, SetParametersResult,
};
use crate::node::{Diagnostics, RosNode};
use crate::wire::Bytes;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use trundle_runtime::settings::reference;
use trundle_runtime::{OperatorCommand, RobotConfig, RunSetting};

/// Name of the service that sets parameters one by one.
const SET: &str = "~/set_parameters";
/// Name of the service that sets all parameters or none.
const SET_ATOMICALLY: &str = "~/set_parameters_atomically";
/// Reason why a parameter is not set.
const READ_ONLY: &str =
    "this setting cannot change while the robot runs: set it in the robot file and start trundle anew";

/// A parameter.
#[derive(Debug, Clone)]
struct Parameter {
    value: ParameterValue,
    description: String,
    constraints: String,
    /// Smallest and largest value, if the parameter may change during a run.
    range: Option<(f64, f64)>,
}

/// All parameters by name. Clones share them.
#[derive(Debug, Clone)]
pub struct Parameters(Arc<Mutex<BTreeMap<String, Parameter>>>);

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
            let range = RunSetting::of_key(setting.key, value.double_value)
                .map(|own| own.range_within(&robot.limits));
            let description = setting.doc.to_owned();
            Some((setting.key.to_owned(), Parameter { value, description, constraints, range }))
        };
        let mut parameters: BTreeMap<String, Parameter> = reference().iter().filter_map(parameter).collect();
        let sim_time = Parameter {
            value: value_of(&Value::Bool(use_sim_time)),
            description: "Whether /clock gives the time.".to_owned(),
            constraints: String::new(),
            range: None,
        };
        parameters.insert("use_sim_time".to_owned(), sim_time);
        Self(Arc::new(Mutex::new(parameters)))
    }

    fn all(&self) -> MutexGuard<'_, BTreeMap<String, Parameter>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn value(&self, name: &str) -> ParameterValue {
        self.all().get(name).map(|parameter| parameter.value.clone()).unwrap_or_default()
    }

    fn describe(&self, name: &str) -> ParameterDescriptor {
        let all = self.all();
        let own = all.get(name);
        let range = own.and_then(|parameter| parameter.range);
        let range =
            range.map(|(from_value, to_value)| FloatingPointRange { from_value, to_value, step: 0.0 });
        ParameterDescriptor {
            name: name.to_owned(),
            r#type: own.map_or(ParameterType::PARAMETER_NOT_SET, |parameter| parameter.value.r#type),
            description: own.map(|parameter| parameter.description.clone()).unwrap_or_default(),
            additional_constraints: own.map(|parameter| parameter.constraints.clone()).unwrap_or_default(),
            read_only: range.is_none(),
            floating_point_range: range.into_iter().collect(),
            ..ParameterDescriptor::default()
        }
    }

    fn list(&self, request: &ListParametersRequest) -> ListParametersResult {
        listing::list(self.all().keys(), request)
    }

    /// Sets a parameter by `send`; why it is not set.
    fn set(
        &self,
        asked: &ParameterMessage,
        send: impl FnOnce(OperatorCommand) -> Result<(), String>,
    ) -> SetParametersResult {
        let change = self.change(asked).and_then(|setting| send(OperatorCommand::Change(setting)));
        if change.is_ok()
            && let Some(parameter) = self.all().get_mut(&asked.name)
        {
            parameter.value = asked.value.clone();
        }
        SetParametersResult { successful: change.is_ok(), reason: change.err().unwrap_or_default() }
    }

    /// The requested change, or the reason for its refusal.
    fn change(&self, asked: &ParameterMessage) -> Result<RunSetting, String> {
        let (name, value) = (&asked.name, &asked.value);
        let all = self.all();
        let own = all.get(name).ok_or_else(|| format!("there is no parameter {name}"))?;
        let (min, max) = own.range.ok_or_else(|| format!("{name}: {READ_ONLY}"))?;
        if value.r#type != own.value.r#type {
            let (found, expected) = (type_name(value.r#type), type_name(own.value.r#type));
            return Err(format!("type of {name} is {found}, expected {expected}"));
        }
        if !(min..=max).contains(&value.double_value) {
            return Err(format!("{name} is {}, expected {min} to {max}", value.double_value));
        }
        RunSetting::of_key(name, value.double_value).ok_or_else(|| format!("{name}: {READ_ONLY}"))
    }

    /// All of the changes, or none: the first that cannot be made is named before any is sent.
    fn set_all(
        &self,
        asked: &[ParameterMessage],
        send: impl Fn(OperatorCommand) -> Result<(), String>,
    ) -> SetParametersResult {
        if let Some(reason) = asked.iter().find_map(|asked| self.change(asked).err()) {
            return SetParametersResult { successful: false, reason };
        }
        let mut results = asked.iter().map(|asked| self.set(asked, &send));
        let success = SetParametersResult { successful: true, reason: String::new() };
        results.find(|result| !result.successful).unwrap_or(success)
    }

    /// Offers the six services of parameters.
    ///
    /// # Errors
    /// When a service cannot be created.
    pub fn offer(&self, node: &mut RosNode, active: &ActiveGoal) -> Result<(), Ros2Error> {
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
        let (own, run, report) = (self.clone(), active.clone(), Refusals::of(node, SET));
        node.serve::<SetParameters>(SET, move |request| SetParametersResponse {
            results: request
                .parameters
                .iter()
                .map(|asked| report.noted(own.set(asked, |command| send(&run, command))))
                .collect(),
        })?;
        let (own, run, report) = (self.clone(), active.clone(), Refusals::of(node, SET_ATOMICALLY));
        node.serve::<SetParametersAtomically>(SET_ATOMICALLY, move |request| {
            let result = report.noted(own.set_all(&request.parameters, |command| send(&run, command)));
            SetParametersAtomicallyResponse { result }
        })
    }
}

/// Reports refused changes under the name of their service.
struct Refusals {
    diagnostics: Diagnostics,
    name: String,
}

impl Refusals {
    fn of(node: &RosNode, service: &str) -> Self {
        Self { diagnostics: node.diagnostics(), name: node.names().resolve(service) }
    }

    /// The result, after a report if it is a refusal.
    fn noted(&self, result: SetParametersResult) -> SetParametersResult {
        if !result.successful {
            self.diagnostics.warn(&self.name, format!("a parameter was not set: {}", result.reason));
        }
        result
    }
}

fn send(run: &ActiveGoal, command: OperatorCommand) -> Result<(), String> {
    run.send(command).map(drop).map_err(|error| error.to_string())
}

/// Name of a type of parameters.
fn type_name(kind: u8) -> &'static str {
    match kind {
        ParameterType::PARAMETER_NOT_SET => "not set",
        ParameterType::PARAMETER_BOOL => "bool",
        ParameterType::PARAMETER_INTEGER => "integer",
        ParameterType::PARAMETER_DOUBLE => "double, as 0.2",
        ParameterType::PARAMETER_STRING => "string",
        _ => "list",
    }
}

/// A value of the settings as a parameter. A value without a parameter type is given as JSON text.
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
    fn every_setting_can_be_read_with_its_meaning() {
        let parameters = Parameters::of(&RobotConfig::default(), true);
        let described = parameters.describe("drive.wheel_radius_m");
        assert!(described.read_only && !described.description.is_empty());
        assert_eq!(described.r#type, ParameterType::PARAMETER_DOUBLE);
        assert_eq!(
            parameters.value("drive.wheel_radius_m").double_value,
            RobotConfig::default().drive.wheel_radius
        );
        assert!(parameters.value("use_sim_time").bool_value);
        assert_eq!(parameters.value("no.such").r#type, ParameterType::PARAMETER_NOT_SET);
    }

    #[test]
    fn a_setting_that_may_change_is_set_within_its_range_and_type() {
        let robot = RobotConfig::default();
        let parameters = Parameters::of(&robot, false);
        let asked =
            |name: &str, value: Value| ParameterMessage { name: name.to_owned(), value: value_of(&value) };
        let sent = std::cell::RefCell::new(Vec::new());
        let set = |asked: ParameterMessage| {
            parameters.set(&asked, |command| {
                sent.borrow_mut().push(command);
                Ok(())
            })
        };
        let speed = "limits.v_m_s";
        let described = parameters.describe(speed);
        assert!(!described.read_only);
        assert_eq!(described.floating_point_range[0].to_value, robot.limits.v);
        assert!(set(asked(speed, 0.2.into())).successful);
        assert_eq!(parameters.value(speed).double_value, 0.2);
        let refused = [
            (asked(speed, 9.5.into()), "limits.v_m_s is 9.5, expected 0.05 to"),
            (asked(speed, 1.into()), "type of limits.v_m_s is integer, expected double"),
            (asked(speed, "fast".into()), "type of limits.v_m_s is string, expected double"),
            (asked("no.such", 1.0.into()), "there is no parameter no.such"),
            (asked("drive.wheel_radius_m", 0.1.into()), "drive.wheel_radius_m: this setting cannot change"),
        ];
        for (asked, reason) in refused {
            let result = set(asked);
            assert!(!result.successful && result.reason.starts_with(reason), "{}", result.reason);
        }
        assert_eq!(*sent.borrow(), [OperatorCommand::Change(RunSetting::Speed(0.2))]);
        let both = [asked("mission_executor.patience_s", 20.0.into()), asked("no.such", 1.0.into())];
        assert!(!parameters.set_all(&both, |_| Ok(())).successful);
        assert_eq!(
            parameters.value("mission_executor.patience_s").double_value,
            robot.mission_executor.patience
        );
        assert!(parameters.set_all(&both[..1], |_| Ok(())).successful);
        assert!(!set(ParameterMessage::default()).successful);
    }
}
