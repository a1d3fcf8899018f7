// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// A chart of points that tell their names: Chart.js draws what stands as JSON beside the canvas (interactive.py).
"use strict";

function perideal_chart(id) {
  const data = JSON.parse(document.getElementById(id + "-data").textContent);
  const short = (v) => v === null || v === undefined ? "–" :
    Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-3) ? v.toExponential(2) : String(+v.toPrecision(3));
  const percent = (v) => (Math.abs(v) < 1e-8 ? (100 * v).toExponential(1) : String(+(100 * v).toPrecision(3)).replace(/^(.*)e-/, "$1e-")) + " %";
  const step = (v, at) => { // ticks at 1, 2 and 5 of each power of ten
    const m = v / Math.pow(10, Math.floor(Math.log10(v) + 1e-9));
    return at.some((a) => Math.abs(m - a) < 1e-6);
  };

  function datasets(axis) {
    return data.lines.filter((line) => line.points.some((p) => p[axis])).map((line) => ({
      label: line.name,
      data: line.points.filter((p) => p[axis]).map((p) => ({ x: p[axis], y: p.error, about: p })),
      showLine: !line.stars, hidden: line.hidden, borderColor: line.color, backgroundColor: line.stars ? line.color : "white",
      borderWidth: line.stars ? 2.5 : 1.5, borderDash: line.dashes, pointStyle: line.marker, pointRadius: line.stars ? 9 : 4.5,
      pointHoverRadius: line.stars ? 12 : 8, pointHoverBorderWidth: 2.5, pointHitRadius: 6, stars: line.stars, order: line.stars ? 0 : 1,
    }));
  }

  const labels = { // the tolerance beside each star
    id: "labels",
    afterDatasetsDraw(chart) {
      chart.data.datasets.forEach((set, k) => {
        if (!set.stars || !chart.isDatasetVisible(k)) return;
        chart.ctx.save();
        chart.ctx.font = "bold 12px sans-serif";
        chart.ctx.fillStyle = set.borderColor;
        chart.getDatasetMeta(k).data.forEach((star, i) => chart.ctx.fillText(set.data[i].about.label, star.x + 11, star.y - 7));
        chart.ctx.restore();
      });
    },
  };

  const chart = new Chart(document.getElementById(id), {
    type: "scatter",
    data: { datasets: datasets(data.axes[0].key) },
    plugins: [labels],
    options: {
      animation: false, responsive: true, maintainAspectRatio: false,
      interaction: { mode: "nearest", intersect: true },
      scales: {
        x: { type: "logarithmic", title: { display: true, text: data.axes[0].title },
             ticks: { callback: (v) => (step(v, [1, 2, 5]) ? (v >= 1e-3 && v < 1e4 ? String(+v.toPrecision(1)) : v.toExponential(0).replace("e+", "e")) : ""), autoSkip: true, maxRotation: 0 } },
        y: { type: "logarithmic", title: { display: true, text: data.y_title }, ticks: { callback: (v) => (step(v, [1, 2, 5]) ? percent(v) : "") } },
      },
      plugins: {
        legend: { position: "right", labels: { usePointStyle: true, boxHeight: 7, padding: 7, font: { size: 11 } } },
        tooltip: {
          backgroundColor: "#1f2933", displayColors: false,
          callbacks: {
            title: (items) => items.map((item) => item.raw.about.name),
            label: (item) => ["error " + percent(item.raw.y)].concat(data.numbers.filter((n) => item.raw.about[n.key] !== undefined).map((n) =>
              n.title + " " + (typeof item.raw.about[n.key] === "number" ? short(item.raw.about[n.key]) : item.raw.about[n.key]) + (n.unit || ""))),
          },
        },
      },
    },
  });

  function show(visible) {
    chart.data.datasets.forEach((set, k) => chart.setDatasetVisibility(k, visible(set.label)));
    chart.update();
  }
  const box = document.getElementById(id + "-buttons");
  const button = (text, action) => {
    const b = document.createElement("button");
    b.textContent = text;
    b.onclick = action;
    box.appendChild(b);
  };
  data.axes.forEach((axis) => button("over " + axis.name, () => {
    const seen = new Map(chart.data.datasets.map((set, k) => [set.label, chart.isDatasetVisible(k)]));
    chart.data.datasets = datasets(axis.key);
    chart.data.datasets.forEach((set) => { set.hidden = seen.has(set.label) ? !seen.get(set.label) : set.hidden; });
    chart.options.scales.x.title.text = axis.title;
    chart.update();
  }));
  button("show all", () => show(() => true));
  button("hide all", () => show(() => false));
  return chart;
}
