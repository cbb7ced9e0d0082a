// The text to copy: options of the program and keywords of Python for everything that the page computes with.

import assert from "node:assert/strict";
import { test } from "node:test";
import { commands, python } from "../src/words.js";

/** Page as `funicular live` makes it with these options. */
const made = {
  file: "cogiro.toml",
  state: {
    kind: "pose",
    pose: [1, -2, 1.5, 0, 0, 30],
    lengths: null,
    rule: "middle",
    set: [
      { path: "platform.motion", value: "point-mass" },
      { path: "loads.force_n", value: [1, 0, -5] },
    ],
    more: {
      hold_lengths_of_pose: true,
      mass_kg: 250,
      static_model: "spring",
      force_n: [0, 0, -200.5],
      target_tension_n: [700],
      max_tension_n: 5000,
    },
  },
  model: { cable_model: "spring", assembly: "consistent", in_plane_only: false, winches: "locked" },
  belowHz: 20,
  response: { input: "fz", output: "az", from: 1, to: 20, points: 400, log: false },
  gradient: { belowHz: 3.2, per: "percent", hold: "pose" },
};

const STATE = [
  "--pose 1,-2,1.5,0,0,30",
  "--tension-rule middle",
  "--hold-lengths-of-pose",
  "--mass-kg 250",
  "--static-model spring",
  "--force-n 0,0,-200.5",
  "--target-tension-n 700",
  "--max-tension-n 5000",
  "--set platform.motion=point-mass",
  "--set 'loads.force_n=[1,0,-5]'",
];
const MODEL = ["--cable-model spring", "--assembly consistent", "--winches locked"];

const lines = (command) => command.split(" \\\n  ");

test("every command has all options of the state, and those that vibrate all options of the model", () => {
  const [statics, ...vibrating] = commands(made).split("\n\n").map(lines);
  assert.deepEqual(statics, ["funicular statics cogiro.toml", ...STATE]);
  assert.deepEqual(
    vibrating.map(([name]) => name.split(" ")[1]),
    ["modes", "frf", "gradient"],
  );
  vibrating.forEach((own) => assert.deepEqual(own.slice(1, 1 + STATE.length + MODEL.length), [...STATE, ...MODEL]));
  assert.ok(
    !commands(made).includes("false") && !commands(made).includes("--in-plane-only"),
    "a switch that is off is left out",
  );
});

test("the script has the same as keywords", () => {
  const script = python(made).split("\n");
  assert.ok(
    script.includes(
      'robot = funicular.Robot.from_file("cogiro.toml").with_({"platform.motion": "point-mass", "loads.force_n": [1, 0, -5]})',
    ),
  );
  assert.ok(
    script.includes(
      'rest = robot.equilibrium(pose=[1, -2, 1.5, 0, 0, 30], tension_rule="middle", hold_lengths_of_pose=True, mass_kg=250, static_model="spring", ' +
        "force_n=[0, 0, -200.5], target_tension_n=[700], max_tension_n=5000)",
    ),
  );
  const models = 'cable_model="spring", assembly="consistent", winches="locked"';
  ["rest.modes(20, ", 'rest.frf(hz, "fz", "az", ', 'rest.gradient(below_hz=3.2, per="percent", hold="pose", '].forEach(
    (call) => {
      assert.ok(
        script.some((line) => line.includes(`${call}${models})`)),
        `${call} in\n${script.join("\n")}`,
      );
    },
  );
});

test("a page without options has commands without options", () => {
  const bare = {
    ...made,
    state: { kind: "file", pose: null, lengths: null, rule: "", set: [], more: {} },
    model: {},
    gradient: null,
  };
  assert.deepEqual(
    commands(bare)
      .split("\n\n")
      .map((command) => lines(command)[1]),
    [undefined, "--below-hz 20", "--input fz"],
  );
  assert.ok(python(bare).includes("robot.equilibrium()") && python(bare).includes("rest.modes(20).frequency_hz"));
  const held = { ...bare, state: { ...bare.state, kind: "lengths", lengths: [6.5, 7] } };
  assert.ok(commands(held).startsWith("funicular statics cogiro.toml \\\n  --lengths-m 6.5,7\n\n"));
  assert.ok(python(held).includes("robot.equilibrium(lengths_m=[6.5, 7])"));
});
