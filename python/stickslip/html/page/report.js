"use strict";
(() => {
  const plots = [...document.querySelectorAll(".plot")];
  const options = {
    responsive: true,
    displaylogo: false,
    // named one by one: the default ones include a button that sends the data to a server
    modeBarButtons: [["toImage"], ["zoom2d", "pan2d"], ["zoomIn2d", "zoomOut2d", "resetScale2d"]],
    toImageButtonOptions: { format: "svg" },
  };
  for (const place of plots) {
    const figure = JSON.parse(place.nextElementSibling.textContent);
    Plotly.newPlot(place, figure.data, figure.layout, options);
  }
  // a sheet of paper is narrower than most windows
  const paper = 660;
  window.addEventListener("beforeprint", () => {
    for (const place of plots) Plotly.relayout(place, { width: paper });
  });
  window.addEventListener("afterprint", () => {
    for (const place of plots) Plotly.relayout(place, { width: null, autosize: true });
  });
})();
