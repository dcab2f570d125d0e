// Mouse, touch and keys: they turn, shift and enlarge the view, and ask what is under them.


const fingers = new Map();
let moved = 0;

canvas.addEventListener("pointerdown", event => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  moved = 0;
  tip.hidden = true;
});
canvas.addEventListener("pointermove", event => {
  const before = fingers.get(event.pointerId);
  if (!before) {
    hover(event);
    return;
  }
  const now = [event.clientX, event.clientY], dx = now[0] - before[0], dy = now[1] - before[1];
  moved += Math.abs(dx) + Math.abs(dy);
  if (fingers.size > 1) {
    const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    const gap = at => Math.hypot(at[0] - other[0], at[1] - other[1]) || 1;
    zoom(gap(now) / gap(before));
    camera.x += dx / 2, camera.y += dy / 2;
  } else if (event.shiftKey || event.buttons & 6) {
    camera.x += dx, camera.y += dy;
  } else turn(-dx * 0.008, dy * 0.008);
  fingers.set(event.pointerId, now);
  frame();
});
for (const end of ["pointerup", "pointercancel"]) {
  canvas.addEventListener(end, event => {
    fingers.delete(event.pointerId);
    if (end === "pointerup" && moved < 5) hover(event);
  });
}
canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("dblclick", () => look(...first()));
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  zoom(Math.exp(-Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 120) * 0.0018));
}, {passive: false});
canvas.addEventListener("keydown", event => {
  const turns = {ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
  if (turns[event.key]) turn(...turns[event.key]);
  else if (event.key === "+" || event.key === "=") zoom(1.2);
  else if (event.key === "-") zoom(1 / 1.2);
  else return;
  event.preventDefault();
});

function turn(aside, over) {
  camera.turn += aside;
  camera.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, camera.tilt + over));
  frame();
}

function zoom(factor) {
  const next = Math.max(0.2, Math.min(200, camera.zoom * factor));
  camera.x *= next / camera.zoom, camera.y *= next / camera.zoom;
  camera.zoom = next;
  frame();
}

function hover(event) {
  const box = canvas.getBoundingClientRect();
  const at = [event.clientX - box.left, event.clientY - box.top], reach = event.pointerType === "touch" ? 18 : 8;
  let best = null, least = Infinity;
  for (const one of targets) {
    const distance = one.b ? toSegment(at, one.a, one.b) : Math.hypot(at[0] - one.a[0], at[1] - one.a[1]);
    // A sensor before a node, a node before a member.
    if (distance < reach && distance + 4 * one.kind < least) best = one, least = distance + 4 * one.kind;
  }
  tip.hidden = !best;
  if (!best) return;
  tip.textContent = best.words();
  tip.style.left = `${Math.max(0, Math.min(at[0] + 14, wide - tip.offsetWidth - 4))}px`;
  tip.style.top = `${Math.max(0, Math.min(at[1] + 14, tall - tip.offsetHeight - 4))}px`;
}

function toSegment(at, a, b) {
  const dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const share = square ? Math.max(0, Math.min(1, ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / square)) : 0;
  return Math.hypot(at[0] - a[0] - share * dx, at[1] - a[1] - share * dy);
}
