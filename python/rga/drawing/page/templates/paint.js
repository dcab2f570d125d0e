// Symbols of the drawing: everything here takes places on the screen [px] and a context of a canvas.

function polyline(pen, points) {
  pen.beginPath();
  points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
}

function arrow(pen, tail, head, colour) {
  const dx = head[0] - tail[0], dy = head[1] - tail[1], length = Math.hypot(dx, dy);
  if (length < 3) return;
  const ux = dx / length, uy = dy / length, size = Math.min(9, 0.6 * length);
  const back = [head[0] - size * ux, head[1] - size * uy], half = 0.4 * size;
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = 1.6;
  polyline(pen, [tail, back]);
  pen.stroke();
  polyline(pen, [head, [back[0] - half * uy, back[1] + half * ux],
    [back[0] + half * uy, back[1] - half * ux]]);
  pen.fill();
}

// A turn about what points to the reader, against the clock where it is positive.
function turnAbout(pen, [x, y], size, colour) {
  const curve = Array.from({length: 25}, (_, k) => {
    const turn = (-140 + 250 * k / 24) * Math.PI / 180 * Math.sign(size);
    return [x + 15 * Math.cos(turn), y - 15 * Math.sin(turn)];
  });
  pen.strokeStyle = colour;
  pen.lineWidth = 1.6;
  polyline(pen, curve.slice(0, -2));
  pen.stroke();
  arrow(pen, curve.at(-4), curve.at(-1), colour);
}

// The ground under a support: a line with hatches below it.
function ground(pen, x, y) {
  polyline(pen, [[x - 13, y], [x + 13, y]]);
  pen.stroke();
  for (const step of [-9, -3, 3, 9]) {
    polyline(pen, [[x + step, y], [x + step - 4, y + 5]]);
    pen.stroke();
  }
}

// links: ends of the directions that are held, as seen.
function support(pen, [x, y], sort, links, colours) {
  pen.strokeStyle = colours.ink;
  pen.fillStyle = colours.paper;
  pen.lineWidth = 1.2;
  if (sort === "fixed") {
    pen.lineWidth = 2.5;
    polyline(pen, [[x - 13, y + 2], [x + 13, y + 2]]);
    pen.stroke();
    pen.lineWidth = 1;
    ground(pen, x, y + 2);
  } else if (sort === "pinned") {
    polyline(pen, [[x, y], [x - 9, y + 14], [x + 9, y + 14]]);
    pen.closePath();
    pen.fill();
    pen.stroke();
    ground(pen, x, y + 14);
  } else {
    for (const [dx, dy] of links) {
      const length = Math.hypot(dx, dy);
      if (length < 3) continue;
      const ux = dx / length, uy = dy / length, tip = [x + dx, y + dy];
      polyline(pen, [[x, y], tip]);
      pen.stroke();
      polyline(pen, [[tip[0] - 6 * uy, tip[1] + 6 * ux], [tip[0] + 6 * uy, tip[1] - 6 * ux]]);
      pen.stroke();
    }
  }
}

function zigzag(pen, [x0, y0], [x1, y1], colour) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const nx = -(y1 - y0) / length * 4.5, ny = (x1 - x0) / length * 4.5;
  const shares = [0, 0.2, 0.27, 0.4, 0.53, 0.66, 0.73, 0.8, 1];
  const sides = [0, 0, 1, -1, 1, -1, 1, 0, 0];
  pen.strokeStyle = colour;
  pen.lineWidth = 1.2;
  polyline(pen, shares.map((share, k) =>
    [x0 + share * (x1 - x0) + sides[k] * nx, y0 + share * (y1 - y0) + sides[k] * ny]));
  pen.stroke();
}

function spiral(pen, [x, y], colour) {
  pen.strokeStyle = colour;
  pen.lineWidth = 1.2;
  polyline(pen, Array.from({length: 50}, (_, k) => {
    const turn = k / 49 * 4.5 * Math.PI, reach = 3 + 8 * k / 49;
    return [x + reach * Math.cos(turn), y + reach * Math.sin(turn)];
  }));
  pen.stroke();
}

// One shape a kind, as on paper.
function sensor(pen, [x, y], kind, colours) {
  const corners = {
    rotation: [[0, -6], [6, 0], [0, 6], [-6, 0]],
    strain: [[-4.5, -4.5], [4.5, -4.5], [4.5, 4.5], [-4.5, 4.5]],
    reaction: [[0, -6], [5.5, 4.5], [-5.5, 4.5]],
    force: [0, 1, 2, 3, 4, 5].map(k =>
      [5.5 * Math.cos(k * Math.PI / 3), 5.5 * Math.sin(k * Math.PI / 3)]),
  }[kind];
  pen.strokeStyle = colours.ink;
  pen.fillStyle = colours.paper;
  pen.lineWidth = 1.4;
  if (corners) {
    polyline(pen, corners.map(([dx, dy]) => [x + dx, y + dy]));
    pen.closePath();
  } else {
    pen.beginPath();
    pen.arc(x, y, 5, 0, 2 * Math.PI);
  }
  pen.fill();
  pen.stroke();
}

// Text where no other text stands; boxes are those that are taken.
function label(pen, text, [x, y], colour, boxes, beyond) {
  const shown = text.length > 24 ? text.slice(0, 23) + "\u2026" : text;
  const wide = pen.measureText(shown).width, high = 13;
  const places = [[6, -5], [-wide - 6, -5], [6, 15], [-wide - 6, 15]];
  if (beyond) {
    // It had best stand beyond its point, in this direction of length one.
    const [right, down] = beyond, away = 5 + (Math.abs(right) * wide + Math.abs(down) * high) / 2;
    places.unshift([right * away - wide / 2, down * away + high / 2 - 3]);
  }
  for (const [dx, dy] of places) {
    const box = [x + dx, y + dy - high + 3, x + dx + wide, y + dy + 3];
    const free = boxes.every(one =>
      box[2] <= one[0] || box[0] >= one[2] || box[3] <= one[1] || box[1] >= one[3]);
    if (free) {
      boxes.push(box);
      pen.fillStyle = colour;
      pen.fillText(shown, x + dx, y + dy);
      return true;
    }
  }
  return false;
}
