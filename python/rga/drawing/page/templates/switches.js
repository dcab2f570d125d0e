// The panel: what is shown.


const panel = document.getElementById("panel");

function element(parent, tag, text = "") {
  const made = parent.appendChild(document.createElement(tag));
  made.textContent = text;
  return made;
}

function section(title) {
  const made = element(panel, "fieldset");
  element(made, "legend", title);
  return made;
}

function toggle(parent, text, table, key, colour) {
  const line = element(parent, "label"), box = element(line, "input");
  box.type = "checkbox";
  box.checked = table[key];
  box.addEventListener("change", () => {
    table[key] = box.checked;
    state();
    frame();
  });
  if (colour) element(line, "i").style.borderColor = colour;
  element(line, "span", text);
}

// One of several, or none.
function choice(parent, texts) {
  ["none", ...texts].forEach((text, k) => {
    const line = element(parent, "label"), box = element(line, "input");
    Object.assign(box, {type: "radio", name: "forces", checked: shown.forces === k - 1});
    box.addEventListener("change", () => {
      shown.forces = k - 1;
      state();
      frame();
    });
    element(line, "span", text);
  });
}

function state() {
  const said = [];
  if (response && shown.deformed) said.push(response.words);
  if (response && shown.forces >= 0) said.push(response.diagrams[shown.forces].words);
  if (said.length && response.at) said.push(`at ${response.at}`);
  document.getElementById("state").textContent = said.join("; ");
}

function switches() {
  const views = section("View");
  for (const [name, angles] of Object.entries(LOOKS)) {
    const button = element(views, "button", name);
    button.type = "button";
    button.addEventListener("click", () => look(...angles));
  }
  toggle(views, "dark", shown, "dark");
  if (response) {
    const states = section("Response");
    toggle(states, "deformed shape", shown, "deformed");
    const slider = element(states, "input");
    Object.assign(slider, {type: "range", min: 0, max: 200, value: 100});
    slider.setAttribute("aria-label", "how many times displacements are enlarged");
    const times = element(states, "span", `${short(shown.scale)} times as large`);
    slider.addEventListener("input", () => {
      shown.scale = response.deformed.scale * slider.value / 100;
      times.textContent = `${short(shown.scale)} times as large`;
      frame();
    });
    choice(section("Forces"), response.diagrams.map(one => one.quantity));
  }
  const parts = section("Show");
  toggle(parts, "supports", shown, "supports");
  if (model.sensors.length) toggle(parts, "sensors", shown, "sensors");
  toggle(parts, "local axes", shown, "axes");
  const names = section("Names");
  toggle(names, "nodes", shown, "nodes");
  toggle(names, "members", shown, "members");
  if (model.sensors.length) toggle(names, "sensors", shown, "sensorNames");
  toggle(names, "supports", shown, "supportNames");
  if (model.loads.length) {
    const loads = section("Loads");
    const colours = model.palettes.light.loads;
    model.loads.forEach((load, k) => toggle(loads, load.words, shown.loads, k, colours[k % colours.length]));
  }
  if (model.groups.length) {
    const groups = section("Groups");
    const colours = model.palettes.light;
    model.groups.forEach((name, k) => toggle(groups, name, shown.groups, k, groupLook(k, colours)[0]));
    if (members.group.includes(-1)) toggle(groups, "in no group", shown, "rest", colours.steel);
  }
}

switches();
state();
look(...first());
new ResizeObserver(frame).observe(stage);
