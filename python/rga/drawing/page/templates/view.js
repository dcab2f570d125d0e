// The view: what is switched on, drawn from where the camera stands.

let waiting = false, targets = [], boxes = [];

function frame() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; draw(); });
}

function draw() {
  const ratio = devicePixelRatio || 1;
  wide = stage.clientWidth, tall = stage.clientHeight;
  canvas.width = Math.round(wide * ratio), canvas.height = Math.round(tall * ratio);
  aim();
  const colours = model.palettes[shown.dark ? "dark" : "light"];
  document.documentElement.classList.toggle("dark", shown.dark);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = colours.paper;
  pen.clearRect(0, 0, wide, tall);
  pen.fillRect(0, 0, wide, tall);
  pen.font = "12px system-ui, sans-serif";
  pen.lineCap = pen.lineJoin = "round";
  const places = model.points.map(seen);
  targets = [], boxes = outside();
  if (shown.supports) drawSupports(places, colours);
  drawMembers(places, colours);
  drawJoined(places, colours);
  if (shown.forces >= 0) drawForces(places, colours, response.diagrams[shown.forces]);
  if (shown.deformed) drawDeformed(places, colours);
  if (shown.axes) drawAxes(places, colours);
  model.loads.forEach((load, k) => {
    if (shown.loads[k]) drawLoad(load, places, colours.loads[k % colours.loads.length]);
  });
  if (shown.sensors) drawSensors(colours);
  drawNames(places, colours);
  drawFoot(colours);
}

// What lies beyond the canvas, where no text may stand.
function outside() {
  const far = 1e9;
  return [[-far, -far, 0, far], [wide, -far, far, far], [-far, -far, far, 0], [-far, tall, far, far]];
}

function drawMembers(places, colours) {
  const faint = shown.deformed || shown.forces >= 0;
  const paths = new Map();
  members.ends.forEach(([i, j], k) => {
    if (!visible(k)) return;
    const group = members.group[k], key = `${group} ${members.frame[k]}`;
    if (!paths.has(key)) paths.set(key, {group, frame: members.frame[k], path: new Path2D()});
    paths.get(key).path.moveTo(...places[i]);
    paths.get(key).path.lineTo(...places[j]);
    const member = members.names[k];
    targets.push({kind: 2, a: places[i], b: places[j], words: () => memberWords(k, member)});
  });
  for (const {group, frame: bends, path} of paths.values()) {
    const [colour, dashes] = groupLook(group, colours);
    pen.strokeStyle = faint ? colours.faint : colour;
    pen.lineWidth = (faint ? 1.2 : bends ? 3.2 : 2) * (members.names.length > 2000 ? 0.6 : 1);
    pen.setLineDash(faint ? [] : dashes);
    pen.stroke(path);
  }
  pen.setLineDash([]);
  const used = new Set(members.ends.flatMap((pair, k) => (visible(k) ? pair : [])));
  const size = model.nodes.length > 600 ? 0 : 2.2;
  for (const node of used) {
    const at = places[node];
    targets.push({kind: 1, a: at, words: () => `node ${model.nodes[node]}\n`
      + model.points[node].map((value, k) => `${"xyz"[k]} = ${value} m`).join(", ")});
    if (!size || faint) continue;
    pen.fillStyle = colours.ink;
    pen.beginPath();
    pen.arc(at[0], at[1], size, 0, 2 * Math.PI);
    pen.fill();
  }
}

function groupLook(group, colours) {
  if (group < 0) return [colours.steel, []];
  const turn = Math.floor(group / colours.groups.length);
  return [colours.groups[group % colours.groups.length], model.dashes[turn % model.dashes.length]];
}

function memberWords(k, name) {
  const lines = [`member ${name}`, members.words[k]];
  for (const diagram of response ? response.diagrams : []) {
    if (diagram.quantity !== "N" && !members.frame[k]) continue;
    const values = diagram.values[k].map(value => value * diagram.factor);
    const least = Math.min(...values), most = Math.max(...values);
    const even = most - least <= 1e-6 * Math.max(Math.abs(most), Math.abs(least));
    lines.push(`${diagram.quantity} = ${even ? short(most) : `${short(least)} to ${short(most)}`} ${diagram.unit}`);
  }
  return lines.join("\n");
}

const short = value => String(Number(value.toPrecision(3))).replace("-", "\u2212");

function drawSupports(places, colours) {
  for (const one of model.supports) {
    const links = one.held.map(direction => {
      const [x, y] = turned(direction), sign = y >= 0 ? 17 : -17;
      return [sign * x, sign * y];
    });
    support(pen, places[one.node], one.sort, links, colours);
    targets.push({kind: 0, a: [places[one.node][0], places[one.node][1] + 10],
      words: () => `support ${one.name}\n${one.words}`});
  }
  for (const one of model.springs) {
    const at = places[one.node];
    if (one.turns) spiral(pen, at, colours.ink);
    else if (one.to !== null) zigzag(pen, at, places[one.to], colours.ink);
    else {
      const [x, y] = turned(one.direction), sign = y >= 0 ? 30 : -30;
      zigzag(pen, at, [at[0] + sign * x, at[1] + sign * y], colours.ink);
    }
  }
}

function drawJoined(places, colours) {
  pen.strokeStyle = pen.fillStyle = colours.ink;
  pen.lineWidth = 1.2;
  pen.setLineDash([1, 4]);
  for (const pair of model.ties) {
    polyline(pen, pair.map(node => places[node]));
    pen.stroke();
  }
  pen.setLineDash([]);
  for (const one of model.masses) {
    const [x, y] = places[one.node];
    pen.fillRect(x - 4.5, y - 4.5, 9, 9);
    targets.push({kind: 0, a: [x, y], words: () => one.words});
  }
}

// A point of a member between its ends, and how the deformed shape moves it.
function along(k, share) {
  const [a, b] = members.ends[k].map(node => model.points[node]);
  return a.map((value, axis) => value + share * (b[axis] - value));
}

function drawDeformed(places, colours) {
  const path = new Path2D(), curves = response.deformed.curves;
  curves.forEach((curve, k) => {
    if (!visible(k)) return;
    const last = curve.length - 1;
    for (let s = 0; s <= last; s++) {
      const point = along(k, s / last).map((value, axis) => value + shown.scale * curve[s][axis]);
      if (s) path.lineTo(...seen(point));
      else path.moveTo(...seen(point));
    }
  });
  pen.strokeStyle = colours.deformed;
  pen.lineWidth = 2.2;
  pen.stroke(path);
}

function drawForces(places, colours, diagram) {
  if (!diagram.largest) return;
  const both = diagram.quantity === "N", reach = (both ? 12 : REACH) / diagram.largest;
  const written = [];
  pen.globalAlpha = 0.5;
  diagram.values.forEach((values, k) => {
    if (!visible(k)) return;
    const [a, b] = members.ends[k].map(node => places[node]);
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const side = both ? [-(b[1] - a[1]) / length, (b[0] - a[0]) / length] : turned(diagram.sides[k]);
    const foot = share => [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
    for (const part of stretches(diagram.positions[k], values)) {
      const edge = way => part.map(([share, value]) =>
        foot(share).map((at, axis) => at + way * reach * value * side[axis]));
      pen.fillStyle = part.some(([, value]) => value > 0) ? colours.positive : colours.negative;
      polyline(pen, [...edge(1), ...edge(both ? -1 : 0).reverse()]);
      pen.fill();
    }
    for (const n of diagram.told[k]) {
      const [x, y] = foot(diagram.positions[k][n]), lift = both ? 0 : reach * values[n];
      const long = Math.hypot(...side) || 1, way = side.map(one => Math.sign(values[n]) * one / long);
      const at = [x + lift * side[0], y + lift * side[1]];
      written.push([Math.abs(values[n]), at, values[n], both ? null : way]);
    }
  });
  pen.globalAlpha = 1;
  written.sort((one, other) => other[0] - one[0]);
  const texts = new Set();
  for (const [size, at, value, beyond] of written) {
    const text = short(value * diagram.factor);
    // Members that meet tell of the same value once.
    const here = `${text} ${at.map(one => Math.round(one / 8))}`;
    if (size <= 1e-9 * diagram.largest || texts.has(here) || texts.size >= MOST_VALUES) continue;
    texts.add(here);
    label(pen, text, at, colours.ink, boxes, beyond);
  }
}

// Places and values in stretches of one sign, cut where the values pass zero.
function stretches(places, values) {
  const found = [[[places[0], values[0]]]];
  for (let s = 1; s < values.length; s++) {
    if (values[s - 1] * values[s] < 0) {
      const share = values[s - 1] / (values[s - 1] - values[s]);
      const zero = [places[s - 1] + share * (places[s] - places[s - 1]), 0];
      found.at(-1).push(zero);
      found.push([zero]);
    }
    found.at(-1).push([places[s], values[s]]);
  }
  return found;
}

function drawAxes(places, colours) {
  members.axes.forEach((axes, k) => {
    if (!visible(k)) return;
    const middle = seen(along(k, 0.5));
    axes.forEach((axis, n) => {
      const [x, y] = turned(axis);
      pen.strokeStyle = pen.fillStyle = colours.axes[n];
      pen.lineWidth = 1.4;
      polyline(pen, [middle, [middle[0] + 22 * x, middle[1] + 22 * y]]);
      pen.stroke();
      if (members.names.length < 200) pen.fillText("xyz"[n], middle[0] + 27 * x - 3, middle[1] + 27 * y + 4);
    });
  });
}

function drawLoad(load, places, colour) {
  const from = (head, force, size) => {
    const [x, y] = turned(force);
    return [head[0] - size * x, head[1] - size * y];
  };
  if (load.path.length) {
    pen.strokeStyle = colour;
    pen.lineWidth = 1.2;
    pen.setLineDash([2, 4]);
    polyline(pen, load.path.map(node => places[node]));
    pen.stroke();
    pen.setLineDash([]);
  }
  load.points.forEach((point, k) => {
    const head = seen(point);
    arrow(pen, from(head, load.forces[k], REACH), head, colour);
  });
  load.turned.forEach((point, k) => {
    const head = seen(point), moment = load.moments[k], tail = from(head, moment, REACH);
    if (Math.hypot(...turned(moment)) < 0.5 * Math.hypot(...moment)) {
      turnAbout(pen, head, dot(moment, cross(...basis)), colour);
      return;
    }
    arrow(pen, tail, head, colour);
    arrow(pen, tail, from(head, moment, 8), colour);
  });
  for (const one of load.along) {
    const [a, b] = one.ends.map(seen), [f, g] = one.forces;
    const steps = Math.max(1, Math.round(Math.hypot(b[0] - a[0], b[1] - a[1]) / 20));
    const tails = [];
    for (let s = 0; s <= steps; s++) {
      const mix = (p, q) => p.map((value, axis) => value + s / steps * (q[axis] - value));
      const foot = mix(a, b), tail = from(foot, mix(f, g), 26);
      tails.push(tail);
      arrow(pen, tail, foot, colour);
    }
    polyline(pen, tails);
    pen.stroke();
  }
}

function drawSensors(colours) {
  for (const one of model.sensors) {
    const at = sensorPlace(one, colours);
    sensor(pen, at, one.kind, colours);
    targets.push({kind: 0, a: at, sensor: one.name, words: () => `sensor ${one.name}\n${one.words}`});
  }
}

function sensorPlace(one, colours) {
  const at = seen(one.at), [x, y] = turned(one.direction), size = Math.hypot(x, y);
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.1;
  if (one.on === "member") {
    const [sx, sy] = turned(one.side);
    const place = [at[0] + 8 * sx + 13 * one.place * x, at[1] + 8 * sy + 13 * one.place * y];
    polyline(pen, [[place[0] - 10 * x, place[1] - 10 * y], [place[0] + 10 * x, place[1] + 10 * y]]);
    pen.stroke();
    return place;
  }
  if (one.kind === "rotation" || size < 0.3) {
    const place = [at[0] + 16 + 13 * one.place, at[1] + 12];
    polyline(pen, [at, place]);
    pen.stroke();
    return place;
  }
  const ux = x / size, uy = y / size, far = 27 + 13 * one.place;
  const away = reach => [at[0] + reach * ux, at[1] + reach * uy];
  // Behind the node, as a dial gauge stands, unless a load comes from there.
  if (one.ahead) arrow(pen, at, away(far - 5), colours.ink);
  else arrow(pen, away(-far), away(-4), colours.ink);
  return away(one.ahead ? far : -far);
}

function drawNames(places, colours) {
  for (const {a: [x, y], sensor: is} of targets) if (is !== undefined) boxes.push([x - 6, y - 6, x + 6, y + 6]);
  let left = MOST_LABELS;
  const write = (text, at, colour) => {
    const inside = at[0] > 0 && at[1] > 0 && at[0] < wide && at[1] < tall;
    if (left > 0 && inside && label(pen, text, at, colour, boxes)) left--;
  };
  if (shown.sensorNames && shown.sensors) {
    for (const one of targets) if (one.sensor !== undefined) write(one.sensor, one.a, colours.ink);
  }
  if (shown.supportNames) for (const one of model.supports) write(one.name, places[one.node], colours.ink);
  if (shown.nodes) model.nodes.forEach((name, k) => write(name, places[k], colours.ink));
  if (shown.members) {
    members.names.forEach((name, k) => { if (visible(k)) write(name, seen(along(k, 0.5)), colours.steel); });
  }
}

function drawFoot(colours) {
  const longest = Math.min(160, 0.3 * wide) / unit, power = 10 ** Math.floor(Math.log10(longest));
  const metres = power * [5, 2, 1].find(step => step * power <= longest * 1.000001);
  const x = 74, y = tall - 18;
  pen.strokeStyle = pen.fillStyle = colours.ink;
  pen.lineWidth = 1.2;
  for (const line of [[[x, y], [x + metres * unit, y]], [[x, y - 4], [x, y + 4]],
    [[x + metres * unit, y - 4], [x + metres * unit, y + 4]]]) {
    polyline(pen, line);
    pen.stroke();
  }
  pen.fillText(`${short(metres)} m`, x + metres * unit + 7, y + 4);
  [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, k) => {
    const [dx, dy] = turned(axis);
    pen.strokeStyle = pen.fillStyle = colours.steel;
    polyline(pen, [[36, tall - 34], [36 + 22 * dx, tall - 34 + 22 * dy]]);
    pen.stroke();
    if (Math.hypot(dx, dy) > 0.2) pen.fillText("xyz"[k], 33 + 29 * dx, tall - 30 + 29 * dy);
  });
}
