// Keeps a page as it would be if it were loaded again: what its server drew otherwise is put in its
// place. Parts that may change have an id and the attribute data-live.

const page = document.documentElement;
const shown = document.getElementById("live");
const drawn = new Map();
const SOON = 500, LATE = 30_000;
let waiting = null;

for (const part of document.querySelectorAll("[data-live]")) drawn.set(part.id, part.outerHTML);

async function redraw() {
  waiting = null;
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
    if (!old || drawn.get(part.id) === part.outerHTML) continue;
    // What somebody reads aloud, or is about to choose, stays until it is left.
    if (old !== document.activeElement && old.contains(document.activeElement)) continue;
    drawn.set(part.id, part.outerHTML);
    old.replaceWith(document.adoptNode(part));
  }
  document.dispatchEvent(new Event("redrawn"));
}

function redrawSoon() {
  waiting ??= setTimeout(redraw, SOON);
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
