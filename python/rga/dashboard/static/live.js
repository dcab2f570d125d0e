// Keeps a page as it would be if it were loaded again: what its server drew otherwise is put in its
// place. Parts that may change have an id and the attribute data-live.

const page = document.documentElement;
const shown = document.getElementById("live");
const drawn = new Map();
// How long to wait for more of what happens at once, and to look without being told [ms]; between
// two times the server rests so many times as long as one has taken.
const SOON = 100, LATE = 30_000, REST = 4;
let waiting = null, next = 0;

for (const part of document.querySelectorAll("[data-live]")) drawn.set(part.id, said(part));

// What a part shows: forms have a new key each time.
function said(part) {
  return part.outerHTML.replace(/name="key" value="[^"]*"/g, "");
}

// What somebody is about to choose, or has begun to fill in, stays.
function inUse(part) {
  const active = document.activeElement;
  const fields = [...part.querySelectorAll("input:not([type=hidden]), textarea")];
  return (part !== active && part.contains(active)) || fields.some((one) => one.value !== one.defaultValue);
}

async function redraw() {
  const begun = performance.now();
  await draw();
  next = performance.now() + REST * (performance.now() - begun);
  waiting = null;
}

async function draw() {
  let answer;
  try {
    answer = await fetch(location.href, { headers: { accept: "text/html" } });
  } catch {
    say("cut off");
    return;
  }
  if (!answer.ok || answer.redirected) {
    say("cut off");
    return;
  }
  const next = new DOMParser().parseFromString(await answer.text(), "text/html");
  for (const part of next.querySelectorAll("[data-live]")) {
    const old = document.getElementById(part.id);
    if (!old || old === part || drawn.get(part.id) === said(part) || inUse(old)) continue;
    drawn.set(part.id, said(part));
    const folded = part.querySelectorAll("details");
    old.querySelectorAll("details").forEach((one, place) => {
      if (one.open && folded[place]) folded[place].open = true;
    });
    old.replaceWith(document.adoptNode(part));
  }
  document.dispatchEvent(new Event("redrawn"));
}

function redrawSoon() {
  waiting ??= setTimeout(redraw, Math.max(SOON, next - performance.now()));
}

function say(words) {
  if (shown && shown.textContent !== words) shown.textContent = words;
}

function listen(address) {
  const stream = new EventSource(address);
  stream.onopen = () => say("live");
  stream.onerror = () => say("cut off");
  for (const kind of ["message", "row", "event", "alarm", "proposal", "account", "reload"]) {
    stream.addEventListener(kind, redrawSoon);
  }
}

if ("livePage" in page.dataset) {
  if (page.dataset.stream) listen(page.dataset.stream);
  setInterval(() => document.hidden || redrawSoon(), LATE);
  document.addEventListener("visibilitychange", () => document.hidden || redrawSoon());
}
