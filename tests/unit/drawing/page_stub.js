// Runs the scripts of a page without a browser: node page_stub.js PAGE [ACTIONS]
// Elements and a canvas that remember what is done to them; prints lines, areas and texts as JSON.
"use strict";
const fs = require("fs"), vm = require("vm");
const page = fs.readFileSync(process.argv[2], "utf8");
const actions = JSON.parse(process.argv[3] || "[]");
const scripts = [...page.matchAll(/<script([^>]*)>([\s\S]*?)<\/script>/g)];
const data = scripts.find(([, kind]) => kind.includes("json"))[2];
const code = scripts.find(([, kind]) => !kind.includes("json"))[2];
const [wide, tall] = [Number(process.env.WIDE || 900), Number(process.env.TALL || 600)];

let drawn = [];
class Trace {
  constructor() { this.parts = []; }
  moveTo(x, y) { this.parts.push([[x, y]]); }
  lineTo(x, y) {
    if (this.parts.length) this.parts.at(-1).push([x, y]);
    else this.moveTo(x, y);
  }
  arc(x, y, r, from, to) {
    this.parts.push(Array.from({length: 17}, (_, k) => {
      const turn = from + (to - from) * k / 16;
      return [x + r * Math.cos(turn), y + r * Math.sin(turn)];
    }));
  }
  closePath() { this.parts.at(-1).push(this.parts.at(-1)[0]); }
}
const pen = {
  trace: new Trace(), globalAlpha: 1,
  beginPath() { this.trace = new Trace(); },
  moveTo(...at) { this.trace.moveTo(...at); }, lineTo(...at) { this.trace.lineTo(...at); },
  arc(...of) { this.trace.arc(...of); }, closePath() { this.trace.closePath(); },
  add(kind, colour, parts) {
    if (!parts.flat(2).every(Number.isFinite)) throw new Error(`${kind} at no place`);
    drawn.push({kind, colour, parts, width: this.lineWidth, alpha: this.globalAlpha});
  },
  stroke(path) { this.add("line", this.strokeStyle, (path || this.trace).parts); },
  fill(path) { this.add("area", this.fillStyle, (path || this.trace).parts); },
  clearRect() { drawn = []; },
  fillRect(x, y, w, h) { this.add("area", this.fillStyle, [[[x, y], [x + w, y + h]]]); },
  fillText(text, x, y) {
    this.add("text", this.fillStyle, [[[x, y]]]);
    drawn.at(-1).text = text;
  },
  measureText: text => ({width: 6.4 * text.length}),
  setTransform() {}, setLineDash() {},
};

class Element {
  constructor(tag) {
    Object.assign(this, {tag, children: [], listeners: {}, style: {}, textContent: "", hidden: false,
      clientWidth: wide, clientHeight: tall, offsetWidth: 120, offsetHeight: 40});
    this.classList = {toggle() {}};
  }
  appendChild(child) { this.children.push(child); return child; }
  setAttribute() {}
  setPointerCapture() {}
  getContext() { return pen; }
  getBoundingClientRect() { return {left: 0, top: 0}; }
  addEventListener(name, does) { (this.listeners[name] ||= []).push(does); }
  fire(name, event = {}) {
    const whole = {preventDefault() {}, pointerId: 1, buttons: 1, ...event};
    for (const does of this.listeners[name] || []) does(whole);
  }
}
const elements = {};
const document = {
  getElementById: id => (elements[id] ||= Object.assign(new Element(id), id === "data" ? {textContent: data} : {})),
  createElement: tag => new Element(tag), documentElement: new Element("html"),
};
const every = node => [node, ...node.children.flatMap(every)];
const waiting = [];
vm.runInNewContext(code, {
  document, Path2D: Trace, devicePixelRatio: 1, console,
  matchMedia: () => ({matches: false}), requestAnimationFrame: does => waiting.push(does),
  ResizeObserver: class { observe() {} },
});
const settle = () => { while (waiting.length) waiting.shift()(); };
settle();
for (const [what, ...of] of actions) {
  if (what === "drag") {
    elements.view.fire("pointerdown", {clientX: 0, clientY: 0});
    elements.view.fire("pointermove", {clientX: of[0], clientY: of[1]});
    elements.view.fire("pointerup", {clientX: of[0], clientY: of[1]});
  } else if (what === "hover") {
    elements.view.fire("pointermove", {clientX: of[0], clientY: of[1], pointerId: 9});
  } else if (what === "switch") {
    const line = every(elements.panel).find(one => one.tag === "label" && one.children.at(-1).textContent === of[0]);
    line.children[0].checked = line.children[0].type === "radio" || !line.children[0].checked;
    line.children[0].fire("change");
  } else if (what === "press") {
    every(elements.panel).find(one => one.tag === "button" && one.textContent === of[0]).fire("click");
  } else elements.view.fire(what, of[0]);
  settle();
}
const panel = every(elements.panel).filter(one => one.tag === "span" || one.tag === "legend" || one.tag === "button");
process.stdout.write(JSON.stringify({
  drawn, tip: elements.tip.hidden ? "" : elements.tip.textContent,
  state: elements.state.textContent, panel: panel.map(one => one.textContent),
}));
