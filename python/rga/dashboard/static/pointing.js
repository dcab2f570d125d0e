// Says the numbers of the sensor that is pointed at, or tapped, below the drawing of its structure.

const said = document.querySelector(".pointed");

function point(event) {
  const reach = event.target.closest?.(".reach");
  const sensor = reach ? document.getElementById(reach.dataset.of) : event.target.closest?.(".sensor");
  if (said && sensor) said.textContent = sensor.querySelector("title").textContent;
}

document.addEventListener("pointerover", point);
document.addEventListener("focusin", point);
