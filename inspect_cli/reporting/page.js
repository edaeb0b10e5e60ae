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
    figure.layout.template = template;
    // A finger that scrolls the page must not draw a zoom box.
    if (coarse) figure.layout.dragmode = false;
    await Plotly.newPlot(plot, figure.data, figure.layout, {
      responsive: true,
      displaylogo: false,
      locale: root.lang,
      locales: { [root.lang]: { dictionary: dictionary } },
      // The wheel belongs to the page; zooming in space is a button.
      scrollZoom: false,
      displayModeBar: hovers ? "hover" : false,
      modeBarButtons: figure.layout.scene ? buttons3d : buttons2d,
    });
    plots.push(plot);
    if (!figure.timed) return;
    timed.push(plot);
    plot.on("plotly_relayout", (change) => zoomTogether(plot, change));
  }

  // Paper has another width than the window, and printing does not resize what stands in it.
  // While the class is set, the style sheet gives the page its printed width.
  function fitTo(paper) {
    root.classList.toggle("printing", paper);
    for (const plot of plots) Plotly.relayout(plot, { autosize: true });
  }
  window.addEventListener("beforeprint", () => fitTo(true));
  window.addEventListener("afterprint", () => fitTo(false));

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
