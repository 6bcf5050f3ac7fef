//! Messages of a broker.

use super::texts;

const HEADER: &str = r#""headerId":1,"timestamp":"2026-11-26T16:00:00.00Z","version":"2.1.0","manufacturer":"trundle","serialNumber":"r1""#;

/// An order of two nodes with an action, an update of it, and instant actions.
pub fn vda5050() -> Vec<Vec<u8>> {
    let wait = r#"{"actionId":"w","actionType":"wait","blockingType":"NONE","actionParameters":[{"key":"duration","value":1.5}]}"#;
    let node = |place: u32, x: f64, actions: &str| {
        format!(
            r#"{{"nodeId":"n{place}","sequenceId":{},"released":true,"actions":[{actions}],"nodePosition":{{"x":{x:?},"y":0.0,"theta":0.5,"allowedDeviationXY":0.3,"allowedDeviationTheta":0.2,"mapId":"map"}}}}"#,
            2 * place
        )
    };
    let edge = r#"{"edgeId":"e","sequenceId":1,"released":true,"startNodeId":"n0","endNodeId":"n1","maxSpeed":0.3,"maxHeight":2.0,"rotationAllowed":true,"actions":[]}"#;
    let order = |update: u32, nodes: &[String], edges: &str| {
        let nodes = nodes.join(",");
        format!(r#"{{{HEADER},"orderId":"a","orderUpdateId":{update},"nodes":[{nodes}],"edges":[{edges}]}}"#)
    };
    let pose = r#"[{"key":"x","value":1.0},{"key":"y","value":"2"},{"key":"theta","value":0},{"key":"mapId","value":"map"}]"#;
    let action = |kind: &str, parameters: &str| {
        format!(
            r#"{{"actionId":"{kind}","actionType":"{kind}","blockingType":"HARD","actionParameters":{parameters}}}"#
        )
    };
    let actions =
        [action("initPosition", pose), action("cancelOrder", "[]"), action("startCharging", "[]")].join(",");
    texts(&[
        &order(0, &[node(0, 0.0, wait), node(1, 2.0, "")], edge),
        &order(1, &[node(1, 2.0, wait)], ""),
        &format!(r#"{{{HEADER},"actions":[{actions}]}}"#),
    ])
}

/// Commands of a home.
pub fn home_command() -> Vec<Vec<u8>> {
    texts(&[
        "stop",
        r#"{"command":"go","x":1.5,"y":-2,"heading_deg":90}"#,
        r#"{"command":"go","place":"kitchen"}"#,
    ])
}
