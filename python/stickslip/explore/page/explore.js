"use strict";
(() => {
  const id = (name) => document.getElementById(name);
  const names = ["curve", "contacts", "damper"];
  const steps = 1000;
  // a newer position is sent at the latest after this time, answered or not [ms]
  const patience = 400;
  const options = {
    responsive: true,
    displaylogo: false,
    modeBarButtons: [["toImage"], ["zoom2d", "pan2d"], ["zoomIn2d", "zoomOut2d", "resetScale2d"]],
    toImageButtonOptions: { format: "svg" },
  };
  const socket = new WebSocket(`ws://${location.host}/socket`);
  let knobs = [], number = 0, answered = 0, later = 0, sent = 0;

  // ------------------------------------------------------------------------------ what is asked

  const message = (want) => JSON.stringify({
    number, want,
    values: knobs.map((knob) => knob.now),
    dof: id("dof").value,
    over: id("over").value,
  });

  const said = (text) => { id("said").textContent = text; };

  const ask = (want) => {
    if (socket.readyState !== WebSocket.OPEN || !knobs.length) return;
    socket.send(message(want));
  };

  const changed = () => {
    clearTimeout(later);
    for (const name of names) state(name, "computing …");
    const wait = answered < number ? patience - (performance.now() - sent) : 0;
    if (wait > 0) {
      later = setTimeout(changed, wait);
      return;
    }
    later = 0;
    number += 1;
    sent = performance.now();
    ask("panes");
  };

  const answer = (newest) => {
    answered = newest;
    if (later) changed();
  };

  // ------------------------------------------------------------------------------ the sliders

  const place = (knob, value) => {
    const { low, high, log } = knob;
    const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return Number.isFinite(share) ? Math.min(Math.max(share, 0), 1) * steps : 0;
  };

  const at = (knob, step) => {
    const { low, high, log } = knob, share = step / steps;
    const value = log ? low * (high / low) ** share : low + share * (high - low);
    return Number(value.toPrecision(4));
  };

  const shown = (knob) => {
    knob.range.value = place(knob, knob.now);
    knob.box.value = knob.now;
    knob.box.removeAttribute("aria-invalid");
    knob.range.setAttribute("aria-valuetext", `${knob.now} ${knob.unit}`);
  };

  const element = (tag, given = {}, text = "") => {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(given)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };

  const control = (knob, position) => {
    const row = element("div", { class: "knob" });
    const said_of = `${knob.group}: ${knob.label}`;
    knob.now = knob.value;
    knob.box = element("input", { type: "number", step: "any", id: `box-${position}`, required: "" });
    knob.range = element("input", {
      type: "range", min: 0, max: steps, step: 1, id: `range-${position}`, "aria-label": said_of,
    });
    row.append(
      element("label", { for: `box-${position}` }, knob.label), knob.box,
      element("span", { class: "unit" }, knob.unit), knob.range,
    );
    knob.range.addEventListener("input", () => {
      knob.now = at(knob, Number(knob.range.value));
      shown(knob);
      changed();
    });
    knob.box.addEventListener("change", () => {
      const value = knob.box.valueAsNumber;
      if (Number.isFinite(value)) {
        knob.now = value;
        shown(knob);
        changed();
      } else {
        knob.box.setAttribute("aria-invalid", "true");
        said(`${said_of}: give a number`);
      }
    });
    shown(knob);
    return row;
  };

  const greeted = (told) => {
    document.title = `${told.name} – stickslip explorer`;
    id("name").textContent = told.name;
    id("description").textContent = told.description;
    knobs = told.knobs;
    let fields = null, group = null;
    for (const [position, knob] of knobs.entries()) {
      if (knob.group !== group) {
        group = knob.group;
        fields = element("fieldset");
        fields.append(element("legend", {}, group));
        id("knobs").append(fields);
      }
      fields.append(control(knob, position));
    }
    for (const dof of told.dofs) id("dof").append(element("option", { value: dof }, dof));
    for (const over of told.overs) {
      id("over").append(element("option", { value: over }, over.replaceAll("_", " ")));
    }
    id("over").disabled = !told.overs.length;
    id("damper").hidden = !told.overs.length;
    changed();
  };

  // ------------------------------------------------------------------------------ what is shown

  const state = (name, text) => {
    id(name).querySelector(".state").textContent = text;
    id(name).querySelector(".content").classList.toggle("outdated", text !== "");
    id(name).setAttribute("aria-busy", text !== "");
  };

  // the scale that was chosen by a button stays
  const keepScale = (before, layout) => {
    const was = before?.updatemenus?.[0], now = layout.updatemenus?.[0];
    if (!was || !now || was.active === now.active) return;
    now.active = was.active;
    for (const [key, value] of Object.entries(now.buttons[now.active].args[0])) {
      const [axis, entry] = key.split(".");
      layout[axis][entry] = value;
    }
  };

  // the server counts the rows of a legend on a wide page
  const fit = (layout, data, width) => {
    const wanted = data.filter((one) => one.showlegend).map((one) => 7 * one.name.length + 60);
    const rows = (room) => {
      let count = wanted.length ? 1 : 0, used = 0;
      for (const size of wanted) {
        if (used && used + size > room) {
          count += 1;
          used = 0;
        }
        used += size;
      }
      return count;
    };
    const more = 22 * Math.max(rows(width - 90) - rows(800), 0);
    layout.height += more;
    layout.margin.b += more;
  };

  const draw = (figure, told) => {
    const old = figure.querySelector(told.still ? "img" : ".plot");
    figure.lastChild.textContent = told.caption;
    if (told.still) {
      const image = old ?? element("img");
      image.src = told.still;
      image.alt = told.description;
      if (!old) figure.replaceChildren(image, figure.lastChild);
      return;
    }
    const plot = old ?? element("div", { class: "plot", role: "group" });
    plot.setAttribute("aria-label", told.description);
    if (!old) figure.replaceChildren(plot, figure.lastChild);
    const { data, layout } = JSON.parse(told.data), width = plot.clientWidth;
    keepScale(plot.layout, layout);
    fit(layout, data, width);
    plot.style.height = `${layout.height}px`;
    // the buttons would lie on the title of a narrow figure
    Plotly.react(plot, data, layout, width < 600 ? { ...options, displayModeBar: false } : options);
  };

  const table = (told) => {
    const made = element("table"), head = element("tr"), body = element("tbody");
    const kind = (column) => (told.numbers[column] ? { class: "number" } : {});
    told.headings.forEach((text, column) => {
      head.append(element("th", { scope: "col", ...kind(column) }, text));
    });
    for (const cells of told.rows) {
      const row = element("tr");
      cells.forEach((text, column) => row.append(element("td", kind(column), text)));
      body.append(row);
    }
    const top = element("thead");
    top.append(head);
    if (told.title) made.append(element("caption", {}, told.title));
    made.append(top, body);
    const scroll = element("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": told.title || "numbers" });
    scroll.append(made);
    return [scroll, ...told.notes.map((text) => element("p", { class: "note" }, text))];
  };

  const told_in = (pane) => {
    const content = id(pane.pane).querySelector(".content");
    const lines = [
      ...pane.failures.map((text) => element("p", { class: "message failure" }, text)),
      ...pane.cautions.map((text) => element("p", { class: "message" }, text)),
    ];
    // figures stay where they are, so that they are redrawn and not made anew
    const figures = [...content.querySelectorAll("figure")];
    for (const figure of figures.splice(pane.figures.length)) figure.remove();
    while (figures.length < pane.figures.length) {
      const figure = element("figure");
      figure.append(element("figcaption"));
      content.append(figure);
      figures.push(figure);
    }
    for (const one of [...content.children]) if (!figures.includes(one)) one.remove();
    content.prepend(...lines);
    content.append(...pane.tables.flatMap(table));
    pane.figures.forEach((one, position) => draw(figures[position], one));
    state(pane.pane, "");
  };

  const saved = (told) => {
    const bytes = told.text ?? Uint8Array.from(atob(told.picture), (sign) => sign.charCodeAt(0));
    const kind = told.text ? "application/toml" : "image/png";
    const link = element("a", { download: told.file });
    link.href = URL.createObjectURL(new Blob([bytes], { type: kind }));
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    said(`saved as ${told.file}`);
  };

  socket.addEventListener("message", ({ data }) => {
    const told = JSON.parse(data);
    if (told.knobs) greeted(told);
    else if (told.file) saved(told);
    else if (told.refused && !knobs.length) lost(told.refused);
    else if (told.refused) {
      said(told.refused);
      for (const name of names) state(name, "");
      answer(number);
    } else if (told.number === number) {
      if (told.share !== undefined) {
        state(told.pane, `computing … ${Math.round(100 * told.share)} %`);
        return;
      }
      told_in(told);
      if (told.pane === "curve") {
        document.body.dataset.milliseconds = Math.round(performance.now() - sent);
        said("");
        answer(number);
      }
    }
  });
  const lost = (text) => {
    if (id("lost").hidden) id("lost").textContent = text;
    id("lost").hidden = false;
    for (const name of names) state(name, "");
  };
  socket.addEventListener("close", () => {
    lost("The explorer has ended. Start it again with stickslip explore, then load this page again.");
  });
  for (const name of ["dof", "over"]) id(name).addEventListener("change", changed);
  id("controls").addEventListener("submit", (event) => event.preventDefault());
  id("reset").addEventListener("click", () => {
    for (const knob of knobs) {
      knob.now = knob.value;
      shown(knob);
    }
    changed();
  });
  for (const want of ["study", "picture"]) {
    id(want).addEventListener("click", () => {
      said("exporting …");
      ask(want);
    });
  }
})();
