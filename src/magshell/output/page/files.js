// What the page saves: the table of the history, and pictures of the shape and of the curves.

const SHARPNESS = 2; // pixels of a picture for each of the page
const MARGIN = 16;

function save(content, type, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

const saveTable = () => save(stored("history", Uint8Array), "text/csv", `${document.title}, history.csv`);

// A drawing as an image of its own, with the colours and letters that it has in the page.
async function image(drawing, box) {
  const copy = drawing.cloneNode(true);
  const style = getComputedStyle(document.documentElement);
  const rules = document.querySelector("style").textContent;
  for (const name of new Set(rules.match(/--[a-z]+/g))) copy.style.setProperty(name, style.getPropertyValue(name));
  copy.style.color = getComputedStyle(drawing).color;
  copy.style.font = getComputedStyle(document.body).font;
  copy.setAttribute("xmlns", SVG);
  copy.setAttribute("viewBox", box.join(" "));
  copy.setAttribute("width", SHARPNESS * box[2]);
  copy.setAttribute("height", SHARPNESS * box[3]);
  copy.removeAttribute("id");
  const named = `#${drawing.id}`;
  const sheet = document.createElementNS(SVG, "style");
  sheet.textContent = rules.replaceAll(/@media[^{]*\{(?:[^{}]*\{[^{}]*\})*[^{}]*\}/g, "").replaceAll(`${named} `, "");
  copy.prepend(sheet);
  const picture = new Image();
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
  await picture.decode();
  return picture;
}

// A sheet of paper of so many pixels of the page, and what is written on it.
class Sheet {
  constructor(width, height) {
    this.canvas = document.createElement("canvas");
    [this.canvas.width, this.canvas.height] = [Math.round(SHARPNESS * width), Math.round(SHARPNESS * height)];
    this.pen = this.canvas.getContext("2d");
    this.pen.scale(SHARPNESS, SHARPNESS);
    this.pen.fillStyle = ink("--back");
    this.pen.fillRect(0, 0, width, height);
  }

  write(text, x, y, size, colour = "--ink", weight = 400) {
    this.pen.font = `${weight} ${size}px ${getComputedStyle(document.body).fontFamily}`;
    this.pen.fillStyle = ink(colour);
    this.pen.textBaseline = "middle";
    this.pen.fillText(text, x, y);
    return this.pen.measureText(text).width;
  }

  async put(drawing, box, x, y, width = box[2], height = box[3]) {
    this.pen.drawImage(await image(drawing, box), x, y, width, height);
  }

  async save(name) {
    save(await new Promise((made) => this.canvas.toBlob(made, "image/png")), "image/png", name);
  }
}

// The shape as it is seen, under its title and the field.
async function savePicture() {
  const { clientWidth: width, clientHeight: height } = at("stage");
  const [head, stage] = [56, at("stage").getBoundingClientRect()];
  const sheet = new Sheet(width, height + head);
  if (scene) {
    const { canvas } = scene.gl;
    const size = [canvas.width, canvas.height];
    [canvas.width, canvas.height] = [SHARPNESS * width, SHARPNESS * height];
    drawScene();
    sheet.pen.drawImage(canvas, 0, head, width, height);
    [canvas.width, canvas.height] = size;
    redraw();
  }
  const bar = at("scale").getBoundingClientRect();
  const [left, top] = [bar.left - stage.left, bar.top - stage.top + head];
  const colours = sheet.pen.createLinearGradient(0, top + bar.height, 0, top);
  state.stops.forEach((colour, i) => colours.addColorStop(i / (state.stops.length - 1), colour));
  sheet.pen.fillStyle = colours;
  sheet.pen.fillRect(left, top, bar.width, bar.height);
  for (const tick of at("ticks").children) {
    const box = tick.getBoundingClientRect();
    const middle = box.top + box.height / 2 - stage.top + head;
    sheet.write(tick.textContent, box.left - stage.left, middle, 12.5, "--grey");
    sheet.pen.fillRect(left + bar.width, middle - 0.5, 4, 1);
  }
  const quantity = at("quantity").getBoundingClientRect();
  sheet.write(at("quantity").textContent, quantity.left - stage.left, quantity.top + 10 - stage.top + head, 15);
  await sheet.put(at("probes"), [0, 0, width, height], 0, head);
  const compass = at("compass").getBoundingClientRect();
  const box = [-70, -70, 240, 140];
  await sheet.put(at("compass"), box, compass.left - stage.left - 20, compass.top - stage.top + head - 20);
  sheet.write(document.title, MARGIN, 19, 17, "--ink", 600);
  let x = MARGIN;
  for (const [id, colour] of [["field", "--accent"], ["step", "--grey"], ["load", "--grey"]]) {
    x += sheet.write(at(id).textContent, x, 43, 13, colour) + MARGIN;
  }
  await sheet.save(`${document.title}, step ${header.steps[state.step].number}.png`);
}

// The curves as they are seen, under the title, over their legend.
async function saveCurves() {
  const { clientWidth: width, clientHeight: height } = at("plot");
  const lines = [[]];
  let room = width - 2 * MARGIN;
  for (const item of at("legend").children) {
    const sample = item.querySelector("svg");
    const wide = (sample ? sample.clientWidth + 5 : 0) + item.textContent.length * 8 + MARGIN;
    if (wide > room && lines.at(-1).length) {
      lines.push([]);
      room = width - 2 * MARGIN;
    }
    lines.at(-1).push([sample, item.textContent]);
    room -= wide;
  }
  const head = 40;
  const sheet = new Sheet(width, head + height + 24 * lines.length + MARGIN);
  sheet.write(document.title, MARGIN, 20, 17, "--ink", 600);
  await sheet.put(at("plot"), [0, 0, width, height], 0, head);
  for (const [row, line] of lines.entries()) {
    let x = MARGIN;
    const y = head + height + 24 * row + 14;
    for (const [sample, text] of line) {
      if (sample) {
        const [wide, high] = [Number(sample.getAttribute("width")), Number(sample.getAttribute("height"))];
        await sheet.put(sample, [0, 0, wide, high], x, y - high / 2);
        x += wide + 5;
      }
      x += sheet.write(text, x, y, 13) + MARGIN;
    }
  }
  await sheet.save(`${document.title}, ${curves.about.name}.png`);
}
