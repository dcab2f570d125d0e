// Where things are on the screen: the model, what is shown of it, and the direction of the look.

const model = JSON.parse(document.getElementById("data").textContent);
const canvas = document.getElementById("view"), stage = document.getElementById("stage");
const tip = document.getElementById("tip"), pen = canvas.getContext("2d");
const start = model.start, members = model.members, response = model.response;
const MOST_LABELS = 400, MOST_VALUES = 80, REACH = 46;

const shown = {
  nodes: start.names.includes("nodes"), members: start.names.includes("members"),
  sensorNames: start.names.includes("sensors"), supportNames: start.names.includes("supports"),
  sensors: start.sensors, supports: true, axes: start.axes,
  groups: model.groups.map(() => true), rest: true,
  loads: model.loads.map(() => start.loads),
  deformed: start.deformed && !!response,
  forces: response ? response.diagrams.findIndex(one => one.quantity === start.forces) : -1,
  scale: response ? response.deformed.scale : 1,
  dark: start.dark || matchMedia("(prefers-color-scheme: dark)").matches,
};

const low = [0, 1, 2].map(k => Math.min(...ends(k))), high = [0, 1, 2].map(k => Math.max(...ends(k)));
const centre = low.map((value, k) => (value + high[k]) / 2);
const radius = Math.hypot(...low.map((value, k) => high[k] - value)) / 2 || 1;
const camera = {};

// The extremes of a coordinate: a spread of all points could be too many arguments.
function ends(axis) {
  let least = Infinity, most = -Infinity;
  for (const point of model.points) {
    least = Math.min(least, point[axis]);
    most = Math.max(most, point[axis]);
  }
  return [least, most];
}

function look(turn, tilt) {
  Object.assign(camera, {turn, tilt, zoom: 1, x: 0, y: 0});
  frame();
}

const LOOKS = {
  "from the side": [0, 0], "from the end": [Math.PI / 2, 0], "from above": [0, Math.PI / 2],
  "inclined": [-0.61, 0.42],
};

function first() {
  if (!model.normal) return LOOKS.inclined;
  return model.normal[1] ? LOOKS["from the side"]
    : model.normal[0] ? LOOKS["from the end"] : LOOKS["from above"];
}

let wide = 1, tall = 1, unit = 1, basis = [[1, 0, 0], [0, 0, 1]];

function aim() {
  const cos = Math.cos(camera.turn), sin = Math.sin(camera.turn);
  const lower = Math.sin(camera.tilt), upper = Math.cos(camera.tilt);
  basis = [[cos, sin, 0], [-sin * lower, cos * lower, upper]];
  unit = camera.zoom * fitted();
}

// Pixels in a metre at which the whole structure is seen, whatever its shape.
function fitted() {
  const margin = 2 * REACH + 20, reach = [1e-9, 1e-9];
  for (let corner = 0; corner < 8; corner++) {
    const at = [0, 1, 2].map(k => ((corner >> k) & 1 ? high[k] : low[k]) - centre[k]);
    basis.forEach((axis, k) => { reach[k] = Math.max(reach[k], Math.abs(dot(axis, at))); });
  }
  return Math.min(Math.max(wide - margin, 60) / reach[0], Math.max(tall - margin, 60) / reach[1],
    1e3 * Math.min(wide, tall) / radius) / 2;
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const turned = vector => [dot(basis[0], vector), -dot(basis[1], vector)];

function seen(point) {
  const [x, y] = turned([point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]]);
  return [wide / 2 + camera.x + unit * x, tall / 2 + camera.y + unit * y];
}

const visible = k => (members.group[k] < 0 ? shown.rest : shown.groups[members.group[k]]);
