// Says times in the zone of the reader beside those in UTC, how long ago they were, and the time at
// which a slider stands.

const zone = new Intl.DateTimeFormat(undefined, { hour: "2-digit", minute: "2-digit", hourCycle: "h23", timeZoneName: "short" });
const dated = new Intl.DateTimeFormat(undefined, {
  month: "short", day: "numeric", hour: "2-digit", minute: "2-digit", hourCycle: "h23",
  timeZoneName: "short",
});
const UNITS = [[172_800, 86_400, "days"], [7_200, 3_600, "h"], [120, 60, "min"], [0, 1, "s"]];

function local(time) {
  if (!time.getTimezoneOffset()) return "";
  const sameDay = time.toISOString().slice(8, 10) === String(time.getDate()).padStart(2, "0");
  return (sameDay ? zone : dated).format(time);
}

function age(time) {
  const behind = (Date.now() - time) / 1000, seconds = Math.abs(behind);
  const [, size, unit] = UNITS.find(([least]) => seconds >= least);
  const span = `${Math.floor(seconds / size)}\u00a0${unit}`;
  return behind >= 0 ? `${span} ago` : `in ${span}`;
}

function say() {
  for (const one of document.querySelectorAll("time[datetime]")) {
    const time = new Date(one.dateTime);
    if (one.classList.contains("age")) {
      one.textContent = age(time);
    } else if (!one.dataset.local) {
      one.dataset.local = local(time) || "UTC";
      if (local(time)) {
        const beside = document.createElement("span");
        beside.className = "local";
        beside.textContent = ` (${local(time)})`;
        one.append(beside);
      }
    }
  }
}

for (const slider of document.querySelectorAll("input[type=range][data-start]")) {
  const start = Date.parse(slider.dataset.start);
  const said = slider.form.querySelector("output");
  const show = () => {
    const time = new Date(start + 1000 * Number(slider.value));
    said.textContent = `${time.toISOString().slice(0, 16).replace("T", " ")} UTC`;
  };
  slider.addEventListener("input", show);
  show();
}

say();
document.addEventListener("redrawn", say);
setInterval(say, 30_000);
