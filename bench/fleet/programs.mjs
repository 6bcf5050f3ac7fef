// Starts the broker and the robot of the test.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

export const place = mkdtempSync(join(tmpdir(), "fleet-"));
export const ROBOT = { manufacturer: "acme", serialNumber: "r1" };
export const PASSWORDS = { robot: "wheels", robot2: "tracks", master: "orders", home: "sofa" };

/** A port that nobody uses. */
export async function freePort() {
  const server = createServer();
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** What a robot may read and write. */
const accessOf = (user, name) => `user ${user}
topic readwrite acme/${name}/#
topic write homeassistant/device/acme_${name}/config
topic read uagv/v2/acme/${name}/order
topic read uagv/v2/acme/${name}/instantActions
topic write uagv/v2/acme/${name}/state
topic write uagv/v2/acme/${name}/visualization
topic write uagv/v2/acme/${name}/connection
topic write uagv/v2/acme/${name}/factsheet
`;

/** Who may read and write what: the example of docs/how-to/home-and-fleet.md, for two robots. */
const ACCESS = `${accessOf("robot", "r1")}
${accessOf("robot2", "r2")}
user master
topic readwrite uagv/v2/#

user home
topic readwrite acme/r1/#
topic read homeassistant/#
topic read uagv/v2/+/+/connection
`;

/** The configuration of a broker that asks for passwords. */
export function configure(broker, port) {
  const file = (name, text) => (writeFileSync(join(place, name), text, { mode: 0o600 }), join(place, name));
  const passwords = file("passwords", Object.entries(PASSWORDS).map(([user, password]) => `${user}:${password}\n`).join(""));
  const maker = [join(dirname(broker), "root/usr/bin/mosquitto_passwd"), "/usr/bin/mosquitto_passwd", "mosquitto_passwd"];
  const made = maker.some((program) => spawnSync(program, ["-U", passwords]).status === 0);
  if (!made) throw new Error("mosquitto_passwd cannot be run");
  const user = process.getuid() === 0 ? "user root\n" : "";
  return file(
    "broker.conf",
    `listener ${port} 127.0.0.1\nallow_anonymous false\npassword_file ${passwords}\nacl_file ${file("access", ACCESS)}\n${user}`,
  );
}

/** A running program; `end` stops it and waits. */
function run(program, args, env = {}) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...env } });
  let text = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (chunk) => (text += chunk));
  const exited = new Promise((resolve) => child.on("exit", resolve));
  const end = async (signal = "SIGINT") => (child.kill(signal), await exited);
  return { child, end, exited, output: () => text };
}

export const startBroker = (broker, file) => run(broker, ["-c", file]);

/** A robot in the simulator, by the clock on the wall, with nothing to do. */
export function startRobot(trundle, port, password = PASSWORDS.robot, robot = ROBOT) {
  const { manufacturer, serialNumber } = robot;
  const user = robot === ROBOT ? "robot" : "robot2";
  const args = ["demo", "--direct", "--goal", "0.1,0,0", "--record", "none", "--out", join(place, `run-${serialNumber}`)];
  const mqtt = ["--mqtt", `mqtt://${user}@127.0.0.1:${port}`, "--mqtt-name", `${manufacturer}/${serialNumber}`, "--mqtt-map", "hall"];
  return run(trundle, [...args, ...mqtt], { TRUNDLE_MQTT_PASSWORD: password });
}

