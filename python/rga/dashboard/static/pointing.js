// Says the numbers of the sensor that is pointed at, below the drawing of its structure.

const said = document.querySelector(".pointed");

function point(event) {
  const sensor = event.target.closest?.(".sensor");
  if (said && sensor) said.textContent = sensor.querySelector("title").textContent;
}

document.addEventListener("pointerover", point);
document.addEventListener("focusin", point);
