// Home and fleet by a real broker: `node test.mjs TRUNDLE MOSQUITTO [SCHEMAS]`. Prints one line for each thing that holds; ends with 1 where one
// does not. SCHEMAS: folder of the JSON schemas of VDA 5050 2.1 (get-schemas.sh).
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import Ajv from "ajv/dist/2020.js";
import mqtt from "mqtt";
import vda from "vda-5050-lib";
import { action, order } from "./orders.mjs";
import { PASSWORDS, ROBOT, configure, freePort, startBroker, startRobot } from "./programs.mjs";

const [trundle, mosquitto, schemas] = process.argv.slice(2);
if (!trundle || !mosquitto) throw new Error("usage: node test.mjs TRUNDLE MOSQUITTO [SCHEMAS]");
const validators = createRequire(import.meta.url)("vda-5050-lib/common/vda-5050-validators-2.0.js");

const port = await freePort();
const config = configure(mosquitto, port);
let broker = startBroker(mosquitto, config);
let robot = startRobot(trundle, port);
let failures = 0;

const wait = (seconds) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
async function until(what, is, seconds = 20) {
  const begin = performance.now();
  while (!is()) {
    assert(performance.now() - begin < 1000 * seconds, `${what}: not within ${seconds} s`);
    await wait(0.02);
  }
  return (performance.now() - begin) / 1000;
}

async function check(name, work) {
  const begin = performance.now();
  try {
    const note = await work();
    console.log(`ok   ${name}${note ? `: ${note}` : ""} (${((performance.now() - begin) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failures += 1;
    console.log(`FAIL ${name}: ${error.stack}\n     last state: ${JSON.stringify(seen.state)}`);
  }
}

/** What the robot publishes, as a listener of its own sees it, and what does not have the standard's form. */
const seen = { state: null, states: [], connections: [], factsheet: null, positions: 0, problems: [], home: {}, pictures: [] };
const url = `mqtt://127.0.0.1:${port}`;
const listen = (username, topics, take) => {
  const client = mqtt.connect(url, { username, password: PASSWORDS[username], reconnectPeriod: 500 });
  client.on("connect", () => client.subscribe(topics));
  client.on("message", take);
  client.on("error", () => {});
  return client;
};
/** The validators of a topic: those of the master's library, which are of version 2.0, and the schemas of version 2.1. */
const ajv = new Ajv({ strict: false, validateFormats: false });
const ofVersion21 = new Map();
const validatorsOf = (topic) => {
  const file = schemas && join(schemas, `${topic}.json`);
  if (!ofVersion21.has(topic)) ofVersion21.set(topic, file && existsSync(file) ? ajv.compile(JSON.parse(readFileSync(file, "utf8"))) : null);
  return [validators[`validate${topic[0].toUpperCase()}${topic.slice(1)}`], ofVersion21.get(topic)].filter(Boolean);
};
const checkForm = (topic, message) => {
  for (const isValid of validatorsOf(topic)) {
    if (!isValid(message)) seen.problems.push(`${topic}: ${JSON.stringify(isValid.errors)}`);
  }
};
const base = `uagv/v2/${ROBOT.manufacturer}/${ROBOT.serialNumber}`;
const listener = listen("master", `${base}/#`, (topic, payload) => {
  const last = topic.split("/").at(-1);
  if (["order", "instantActions"].includes(last)) return;
  const message = JSON.parse(payload);
  checkForm(last, message);
  if (message.version !== "2.1.0") seen.problems.push(`${last}: version ${message.version}`);
  if (last === "state") (seen.state = message), seen.states.push(message);
  if (last === "connection") seen.connections.push(message.connectionState);
  if (last === "factsheet") seen.factsheet = message;
  if (last === "visualization") seen.positions += 1;
});
const home = listen("home", ["acme/r1/#", "homeassistant/#"], (topic, payload) => {
  if (topic.endsWith("/map")) seen.pictures.push(payload);
  else if (!topic.endsWith("/command")) seen.home[topic] = JSON.parse(payload);
});

/** The independent master. It speaks 2.0.0: of messages that are 2.1.0 it reads what both versions have. */
const master = new vda.MasterController(
  {
    interfaceName: "uagv",
    vdaVersion: "2.0.0",
    topicObjectValidation: { inbound: false, outbound: true },
    transport: { brokerUrl: url, heartbeat: 5, username: "master", password: PASSWORDS.master },
  },
  {},
);

/** Gives an order to a robot; what the master's handlers hear about it. */
async function give(given, to = ROBOT) {
  const heard = { nodes: [], edges: [], actions: [], end: null };
  const now = seen.states.length;
  await master.assignOrder(to, given, {
    onOrderProcessed: (error, byCancelation, active) => (heard.end = { error, byCancelation, active }),
    onNodeTraversed: (node) => heard.nodes.push(node.nodeId),
    onEdgeTraversed: (edge) => heard.edges.push(edge.edgeId),
    onActionStateChanged: (state) => heard.actions.push(`${state.actionId} ${state.actionStatus}`),
  });
  return { ...heard, heard, now };
}

/** Does an instant action; its last state, and its error. */
async function instant(done, seconds = 15) {
  let end = null;
  await master.initiateInstantActions(
    ROBOT,
    { instantActions: [done] },
    {
      onActionStateChanged: (state, error) => {
        if (["FINISHED", "FAILED"].includes(state.actionStatus)) end = { status: state.actionStatus, error };
      },
      onActionError: (error) => (end = { status: "ERROR", error }),
    },
  );
  await until(`the end of ${done.actionType}`, () => end, seconds);
  return end;
}

const errors = () => seen.state.errors.map((error) => error.errorType);
const refers = (error, key) => error.errorReferences.find(({ referenceKey }) => referenceKey === key)?.referenceValue;
const at = (x, y) => Math.hypot(seen.state.agvPosition.x - x, seen.state.agvPosition.y - y);
const here = (more = {}) => [seen.state.agvPosition.x, seen.state.agvPosition.y, { allowedDeviationXY: 0.5, allowedDeviationTheta: 3.14, ...more }];
const clear = async () => {
  if (seen.state.nodeStates.length) await instant(action(`clear${performance.now()}`, "cancelOrder"));
};

await check("the robot joins with its password, and says so", async () => {
  await until("a state", () => seen.state, 60);
  await master.start();
  assert.deepEqual(seen.connections, ["ONLINE"]);
  await until("rest", () => !seen.state.driving && seen.state.agvPosition.x > 0.08, 60);
});

await check("factsheet and state have the standard's form", async () => {
  const { physicalParameters, protocolFeatures, typeSpecification } = seen.factsheet;
  assert.equal(typeSpecification.agvKinematic, "DIFF");
  assert(physicalParameters.speedMax > 0 && Math.abs(physicalParameters.width - 0.351) < 1e-6);
  assert(protocolFeatures.agvActions.some(({ actionType }) => actionType === "cancelOrder"));
  assert.equal((await instant(action("state1", "stateRequest"))).status, "FINISHED");
  seen.factsheet = null;
  assert.equal((await instant(action("sheet1", "factsheetRequest"))).status, "FINISHED");
  await until("the factsheet", () => seen.factsheet);
  const checked = [...ofVersion21].filter(([, isValid]) => isValid).map(([topic]) => topic);
  if (schemas) assert.deepEqual(checked.sort(), ["connection", "factsheet", "state", "visualization"]);
  return schemas ? `by the schemas of 2.0 and 2.1: ${checked.join(", ")}` : "by the schemas of 2.0";
});

await check("an order of three nodes with a wait is driven to its end", async () => {
  const three = order("three", 0, 0, [here(), [0.7, 0], [1.2, 0, { theta: 0 }]]);
  three.nodes[1].actions = [action("wait1", "wait", { duration: 0.5 })];
  const { heard } = await give(three);
  await until("the end", () => heard.end, 60);
  assert.deepEqual([heard.end.error, heard.end.byCancelation, heard.end.active], [undefined, false, false]);
  assert.deepEqual([heard.nodes, heard.edges], [["n0", "n1", "n2"], ["e0", "e1"]]);
  assert.equal(heard.actions.at(-1), "wait1 FINISHED");
  assert(at(1.2, 0) < 0.05, `${at(1.2, 0)} m from the last node`);
  return `${(1000 * at(1.2, 0)).toFixed(0)} mm from the last node`;
});

await check("an update while driving continues the order without a stop at its horizon", async () => {
  const { heard } = await give(order("update", 0, 0, [here(), [0.7, 0], [0.1, 0]], 2));
  await until("motion", () => seen.state.orderId === "update" && seen.state.driving);
  assert.equal(seen.state.newBaseRequest, true);
  const { heard: second } = await give(order("update", 1, 1, [[0.7, 0], [0.2, 0]]));
  await until("the update", () => seen.state.orderUpdateId === 1);
  await until("the end", () => second.end, 60);
  assert(!heard.end?.error && !second.end.error && at(0.2, 0) < 0.05, `${at(0.2, 0)} m from the last node`);
});

await check("an order is cancelled in mid-drive", async () => {
  const { heard } = await give(order("cancel", 0, 0, [here(), [1.6, 0]]));
  await until("motion", () => seen.state.orderId === "cancel" && seen.state.velocity.vx > 0.1);
  const end = await instant(action("cancel1", "cancelOrder"));
  assert.equal(end.status, "FINISHED");
  assert.deepEqual([seen.state.nodeStates, seen.state.edgeStates, seen.state.driving], [[], [], false]);
  assert(heard.end.byCancelation && at(1.6, 0) > 0.3);
  const none = await instant(action("cancel2", "cancelOrder"));
  assert.deepEqual([none.status, none.error.errorType], ["FAILED", "noOrderToCancel"]);
});

await check("a pause holds the robot, and it goes on", async () => {
  const { heard } = await give(order("pause", 0, 0, [here(), [1.4, 0]]));
  await until("motion", () => seen.state.orderId === "pause" && seen.state.driving);
  assert.equal((await instant(action("pause1", "startPause"))).status, "FINISHED");
  assert.deepEqual([seen.state.paused, seen.state.driving], [true, false]);
  assert.equal((await instant(action("pause2", "stopPause"))).status, "FINISHED");
  await until("the end", () => heard.end, 60);
  assert(!heard.end.error && at(1.4, 0) < 0.05);
});

await check("orders that do not fit are rejected with the standard's errors", async () => {
  const rejected = async (given) => {
    const { heard } = await give(given);
    await until(`the rejection of ${given.orderId}`, () => heard.end?.error);
    assert.equal(refers(heard.end.error, "orderId"), given.orderId);
    return heard.end.error.errorType;
  };
  assert.equal(await rejected(order("far", 0, 0, [[9, 9], [1, 0]])), "noRouteError");
  const lift = order("lift", 0, 0, [here(), [1, 0]]);
  lift.nodes[1].actions = [action("lift1", "pick")];
  assert.equal(await rejected(lift), "orderError");
  const curve = order("map", 0, 0, [here(), [1, 0, { mapId: "attic" }]]);
  assert.equal(await rejected(curve), "orderError");
  await give(order("gap", 0, 0, [here(), [0.9, 0]]));
  await until("motion", () => seen.state.orderId === "gap" && seen.state.driving);
  assert.equal(await rejected(order("gap", 1, 5, [[3, 0], [1, 0]])), "orderUpdateError");
  assert.equal(seen.state.orderUpdateId, 0, "the order goes on");
  await clear();
});

await check("garbage on the topics is reported, and a flood of it does not stall the robot", async () => {
  listener.publish(`${base}/order`, "{");
  await until("the error", () => errors().includes("validationError"));
  const { heard } = await give(order("flood", 0, 0, [here(), [0.5, 0]]));
  await until("motion", () => seen.state.orderId === "flood" && seen.state.driving);
  for (let i = 0; i < 20_000; i += 1) listener.publish(`${base}/instantActions`, "[".repeat(200));
  listener.publish(`${base}/order`, Buffer.alloc(600_000, 32));
  const seconds = await until("the end of the order", () => heard.end, 60);
  assert(!heard.end.error, JSON.stringify(heard.end));
  await until("an answer behind the flood", () => errors().includes("validationError"), 60);
  assert.equal((await instant(action("behind", "stateRequest"), 60)).status, "FINISHED");
  return `20,000 messages; the order was done after ${seconds.toFixed(1)} s`;
});

await check("the robot goes on while the broker is gone, and comes back", async () => {
  const { heard } = await give(order("gone", 0, 0, [here(), [1.3, 0]]));
  await until("motion", () => seen.state.orderId === "gone" && seen.state.driving);
  await broker.end("SIGKILL");
  await until("the warning", () => robot.output().includes("no connection to"), 30);
  await wait(4);
  seen.connections.length = 0;
  broker = startBroker(mosquitto, config);
  await until("the robot is back", () => seen.connections.includes("ONLINE"), 60);
  await until("the node", () => seen.state.nodeStates.length === 0 && at(1.3, 0) < 0.05, 60);
  assert(robot.output().includes("again"));
  return heard.end ? "" : "the master's library hears no more of the order after its own reconnection";
});

await check("Home Assistant finds the robot, its state and its map", async () => {
  const found = seen.home["homeassistant/device/acme_r1/config"];
  assert.deepEqual(found.device.identifiers, ["acme_r1"]);
  const parts = Object.values(found.components);
  assert(parts.every(({ platform }) => platform) && parts.some(({ platform }) => platform === "vacuum"));
  assert.equal(found.availability[0].topic, `${base}/connection`);
  const state = () => seen.home[found.components.vacuum.state_topic].state;
  await until("rest in the state", () => ["idle", "docked"].includes(state()), 10);
  await until("a picture of the map", () => seen.pictures.length, 20);
  assert.equal(seen.pictures.at(-1).subarray(1, 4).toString(), "PNG");
  return `${seen.pictures.length} pictures, ${seen.pictures.at(-1).length} bytes`;
});

await check("commands of the home are carried out or refused with the reason", async () => {
  const command = async (payload) => {
    delete seen.home["acme/r1/reply"];
    home.publish("acme/r1/command", typeof payload === "string" ? payload : JSON.stringify(payload));
    await until("a reply", () => seen.home["acme/r1/reply"]);
    return seen.home["acme/r1/reply"];
  };
  const word = () => seen.home["acme/r1/state"].state;
  assert.equal((await command({ command: "go", x: 0.5, y: 0, heading_deg: 180 })).accepted, true);
  await until("motion", () => word() === "cleaning");
  // The vehicle's state comes by a topic of its own, at most so often per second.
  await until("manual operation in the vehicle's state", () => seen.state.operatingMode === "MANUAL");
  const { heard } = await give(order("busy", 0, 0, [here(), [1, 0]]));
  await until("the rejection", () => heard.end?.error);
  await command("pause");
  await until("the pause", () => word() === "paused");
  await command("start");
  await until("motion", () => word() === "cleaning");
  await command("stop");
  await until("rest", () => word() === "idle");
  assert.match((await command("fly")).text, /'fly' is not a command; expected start/);
  assert.match((await command({ command: "go", place: "moon" })).text, /no place 'moon'/);
});

await check("two robots under one master: one order is cancelled, the other driven to its end", async () => {
  const second = { ...ROBOT, serialNumber: "r2" };
  const other = startRobot(trundle, port, PASSWORDS.robot2, second);
  let state = null;
  const ears = listen("master", `uagv/v2/acme/r2/state`, (topic, payload) => {
    state = JSON.parse(payload);
    checkForm("state", state);
  });
  try {
    await until("the second robot at rest", () => state && !state.driving && state.agvPosition.x > 0.08, 60);
    await clear();
    const stays = await give(order("stays", 0, 0, [here(), [seen.state.agvPosition.x < 0.8 ? 1.4 : 0.2, 0]]));
    const start = [state.agvPosition.x, state.agvPosition.y, { allowedDeviationXY: 0.5, allowedDeviationTheta: 3.14 }];
    const drives = await give(order("drives", 0, 0, [start, [1.0, 0]]), second);
    await until("both in motion", () => seen.state.driving && state.driving && seen.state.orderId === "stays" && state.orderId === "drives");
    assert.equal((await instant(action("cancel3", "cancelOrder"))).status, "FINISHED");
    assert(stays.heard.end.byCancelation);
    await until("the end of the second robot's order", () => drives.heard.end, 60);
    assert(!drives.heard.end.error && !drives.heard.end.byCancelation);
    const away = Math.hypot(state.agvPosition.x - 1.0, state.agvPosition.y);
    assert(away < 0.05, `${away} m from the node`);
  } finally {
    ears.end(true);
    await other.end();
  }
});

await check("the robot says goodbye when it ends, and the broker when it dies", async () => {
  await robot.end();
  await until("OFFLINE", () => seen.connections.at(-1) === "OFFLINE");
  robot = startRobot(trundle, port);
  await until("ONLINE", () => seen.connections.at(-1) === "ONLINE", 60);
  await robot.end("SIGKILL");
  await until("CONNECTIONBROKEN", () => seen.connections.at(-1) === "CONNECTIONBROKEN", 30);
});

await check("a wrong password is named, and every message had the standard's form", async () => {
  robot = startRobot(trundle, port, "wrong");
  await until("the warning", () => /no connection to .*(authori|password|Refused)/i.test(robot.output()), 60);
  await robot.end();
  assert.deepEqual(seen.problems.slice(0, 3), []);
  return `${seen.states.length} states, ${seen.positions} positions`;
});

for (const client of [listener, home]) client.end(true);
await Promise.race([master.stop(), wait(2)]);
await broker.end("SIGKILL");
process.exit(failures ? 1 : 0);
