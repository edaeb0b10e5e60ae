"use strict";
// Draws every figure from the JSON beside it, keeps the time axes together, and says on the
// root element how many were drawn (data-figures) and how many failed (data-failures).
(function () {
  const root = document.documentElement;
  const template = JSON.parse(document.getElementById("plot-template").textContent);
  const dictionary = JSON.parse(document.getElementById("plot-words").textContent);
  const coarse = window.matchMedia("(pointer: coarse)").matches;
  const hovers = window.matchMedia("(hover: hover)").matches;
  const buttons2d = [["toImage", "zoom2d", "pan2d", "resetScale2d"]];
  const buttons3d = [["toImage", "zoom3d", "pan3d", "orbitRotation", "resetCameraDefault3d"]];
  const timed = [];
  const plots = [];
  const titleRoom = 24;
  let failures = 0;
  let zooming = false;

  window.addEventListener("error", function () {
    root.dataset.failures = String(++failures);
  });

  function zoomTogether(source, change) {
    const reset = change["xaxis.autorange"];
    const from = change["xaxis.range[0]"];
    if (zooming || (!reset && from === undefined)) return;
    const update = reset
      ? { "xaxis.autorange": true }
      : { "xaxis.range": [from, change["xaxis.range[1]"]] };
    zooming = true;
    Promise.all(
      timed.filter((plot) => plot !== source).map((plot) => Plotly.relayout(plot, update))
    ).finally(function () {
      zooming = false;
    });
  }

  async function draw(script) {
    const plot = document.getElementById(script.dataset.plot);
    const figure = JSON.parse(script.textContent);
    plot.dataset.height = plot.style.height;
    figure.layout.template = template;
    // A finger that scrolls the page must not draw a zoom box.
    if (coarse) figure.layout.dragmode = false;
    await Plotly.newPlot(plot, figure.data, figure.layout, {
      displaylogo: false,
      locale: root.lang,
      locales: { [root.lang]: { dictionary: dictionary } },
      // The wheel belongs to the page; zooming in space is a button.
      scrollZoom: false,
      displayModeBar: hovers ? "hover" : false,
      modeBarButtons: figure.layout.scene ? buttons3d : buttons2d,
    });
    // The figure's label and caption say what it shows; loose numbers of its axes would not.
    for (const drawing of plot.querySelectorAll("svg.main-svg, canvas")) {
      drawing.setAttribute("aria-hidden", "true");
    }
    plots.push(plot);
    await fit(plot);
    if (!figure.timed) return;
    timed.push(plot);
    plot.on("plotly_relayout", (change) => zoomTogether(plot, change));
  }

  // The axes whose titles are as the figure has them, and longer than there is room for.
  function crowded(plot) {
    const full = plot._fullLayout;
    return Object.keys(full).filter(function (name) {
      if (!/^[xy]axis[0-9]*$/.test(name)) return false;
      const title = plot.querySelector(`.g-${name.replace("axis", "")}title text`);
      if (!title) return false;
      const box = title.getBoundingClientRect();
      return Math.max(box.width, box.height) > full[name]._length + titleRoom;
    });
  }

  // Two lines of about the same length.
  function broken(text) {
    const blanks = [...text.matchAll(/ (?![^<]*>)/g)].map((blank) => blank.index);
    if (!blanks.length) return text;
    const off = (at) => Math.abs(2 * at - text.length);
    const at = blanks.reduce((best, blank) => (off(blank) < off(best) ? blank : best));
    return `${text.slice(0, at)}<br>${text.slice(at + 1)}`;
  }

  // Fits a figure to the width that it has now: titles of axes are broken where they are longer
  // than their axis, and with equal scales the height left over goes.
  async function fit(plot) {
    plot.style.height = plot.dataset.height;
    const whole = { autosize: true };
    for (const [name, text] of Object.entries(plot.titles || {})) {
      whole[`${name}.title.text`] = text;
    }
    if (plot.titles) await Plotly.relayout(plot, whole);
    plot.titles = plot.titles || {};
    const shorter = {};
    for (const name of crowded(plot)) {
      const text = plot.titles[name] || plot.layout[name].title.text;
      plot.titles[name] = text;
      shorter[`${name}.title.text`] = broken(text);
    }
    if (Object.keys(shorter).length) await Plotly.relayout(plot, shorter);
    // Margins follow the labels that a lower figure has: the second time it is about nothing.
    for (let again = 0; again < 3; again++) {
      const { yaxis, _size: room } = plot._fullLayout;
      if (!yaxis || !yaxis.scaleanchor) return;
      const spare = Math.floor(room.h - yaxis._length);
      if (spare < 1) return;
      plot.style.height = `${plot.clientHeight - spare}px`;
      await Plotly.relayout(plot, { autosize: true });
    }
  }

  // Paper cannot be scrolled: a table that is too wide for it is set smaller.
  function fitTables(paper) {
    for (const table of document.querySelectorAll(".scroll > table")) {
      table.style.zoom = "";
      const share = table.parentElement.clientWidth / table.offsetWidth;
      if (paper && share < 1) table.style.zoom = String(share);
    }
  }

  // Paper has another width than the window, and printing does not resize what stands in it.
  // While the class is set, the style sheet gives the page its printed width.
  function fitTo(paper) {
    root.classList.toggle("printing", paper);
    fitTables(paper);
    plots.forEach(fit);
  }
  window.addEventListener("beforeprint", () => fitTo(true));
  window.addEventListener("afterprint", () => fitTo(false));

  // A phone's address bar changes the height alone, which concerns no figure.
  let width = window.innerWidth;
  let waiting = 0;
  window.addEventListener("resize", function () {
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    clearTimeout(waiting);
    waiting = setTimeout(() => plots.forEach(fit), 100);
  });

  async function drawAll() {
    for (const script of document.querySelectorAll("script[data-plot]")) {
      try {
        await draw(script);
      } catch (error) {
        failures += 1;
        console.error(script.dataset.plot, error);
      }
      root.dataset.figures = String(plots.length);
    }
    root.dataset.failures = String(failures);
    root.dataset.drawn = "true";
  }

  drawAll();
})();
