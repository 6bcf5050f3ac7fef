//! What a viewer sends changes nothing.

use crate::shown_run::ShownRun;
use crate::viewer::Viewer;
use serde_json::json;
use std::time::Duration;
use tokio_tungstenite::tungstenite::Message;

#[test]
fn no_message_of_a_viewer_reaches_the_robot() {
    let run = ShownRun::start();
    let mut viewer = Viewer::enter(run.server.address());
    viewer.wait_for("advertise");
    viewer.subscribe(1, 1);
    viewer.wait_for_data(1);
    let before = run.operator.peek().unwrap();
    for message in [
        json!({"op": "advertise", "channels": [{"id": 1, "topic": "/goal", "encoding": "json", "schemaName": ""}]}),
        json!({"op": "setParameters", "parameters": [{"name": "speed", "value": 1.0}], "id": "1"}),
        json!({"op": "getParameters", "parameterNames": [], "id": "1"}),
        json!({"op": "fetchAsset", "uri": "file:///etc/passwd", "requestId": 1}),
        json!({"op": "subscribeConnectionGraph"}),
        json!({"op": "stop"}),
    ] {
        viewer.send_json(&message);
        let answer = viewer.wait_for("status");
        assert_eq!(answer["level"], 2, "{message}: {answer}");
        assert!(answer["message"].as_str().unwrap().contains("to view only"), "{answer}");
    }
    // A published message, a call of a service, a request of a playback.
    for code in 1..=3 {
        viewer.send(Message::Binary(vec![code, 1, 0, 0, 0, b'{', b'}'].into())).unwrap();
        assert_eq!(viewer.wait_for("status")["level"], 2);
    }
    viewer.wait_for_data(1);
    let after = run.operator.peek().unwrap();
    assert_eq!((after.mission.id, &after.state, after.hold), (before.mission.id, &before.state, before.hold));
    assert_eq!(after.settings, before.settings);
    // The number of the first request is 1: no request was sent.
    assert_eq!(run.operator.send(trundle_runtime::OperatorCommand::Pause).unwrap(), 1);
}

#[test]
fn large_broken_and_many_messages_end_the_connection_and_not_the_server() {
    let run = ShownRun::start();
    let address = run.server.address();
    let mut large = Viewer::enter(address);
    // The server may close the connection during the transfer.
    _ = large.send(Message::Text(" ".repeat(10_000_000).into()));
    large.wait_for_close();
    let mut broken = Viewer::enter(address);
    broken.send(Message::Text("[".repeat(60_000).into())).unwrap();
    assert_eq!(broken.wait_for("status")["level"], 2);
    let mut sender = Viewer::enter(address);
    let sent = (0..2000).take_while(|_| sender.send(Message::Text("{}".into())).is_ok()).count();
    assert!(sent > 50, "{sent}");
    let (code, reason) = sender.wait_for_close();
    assert!(code == 0 || reason.contains("too many refused messages"), "{code} {reason}");
    std::thread::sleep(Duration::from_millis(50));
    Viewer::enter(address).wait_for("advertise");
}
