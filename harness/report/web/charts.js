// Charts with a cursor, a zoom and a mark of the moment: what the page's drawings show, by uPlot.

const kChartHeight = 250;
const kLeastAxisWidth = 62;  // pixels, of an upright one: charts one above the other are in line
const kMostDecades = 8;      // with a tick
const kLastDecade = 15;      // of a logarithmic axis; uPlot has no ticks from 10¹⁷ on. Lines leave it upwards
const kNarrow = 480;  // pixels, below which axes have fewer ticks

// The rows of a chart as uPlot takes them: one row of x, and of each series y, with null where it
// has no value.
function alignedRows(chart) {
  const tables = chart.series.map((series) => {
    const y = Array.from(floatsOf(series.y), (value) => Number.isFinite(value) ? value : null);
    return [Array.from(floatsOf(series.x)), y];
  });
  return tables.length > 0 ? uPlot.join(tables) : [[]];
}

// The same as they are drawn: on a logarithmic axis what is below it stands at its foot.
function drawnRows(chart, [x, ...rows]) {
  if (chart.yScale !== "log") return [x, ...rows];
  return [x, ...rows.map((row) => row.map((y) => Number.isFinite(y) ? Math.max(y, chart.leastY) : y))];
}

// A series of two points one above the other is a limit of x.
function verticalLimit(series) {
  const x = series.x ? floatsOf(series.x) : [];
  return x.length === 2 && x[0] === x[1] ? x[0] : null;
}

// `valueAt(series, index)`: what is read there, whatever is drawn.
function seriesOptions(series, valueAt) {
  const colour = paletteColour(`c${series.colour}`);
  const options = {
    label: series.name,
    stroke: colour,
    width: 1.8,
    dash: series.dashed ? [7, 5] : undefined,
    value: (_, drawn, place, index) => {
      const value = index === null || index === undefined ? drawn : valueAt(place, index);
      return value === null || value === undefined ? "–" : formatNumber(value);
    },
    points: {show: false},
  };
  if (series.mark === "steps") options.paths = uPlot.paths.stepped({align: 1});
  if (series.mark === "points") {
    options.paths = () => null;
    options.points = {show: true, size: 7, fill: colour, stroke: colour};
  }
  return options;
}

// As wide as its numbers, so that the label stands beside them.
function axisWidth(plot, texts, index) {
  const axis = plot.axes[index];
  plot.ctx.save();
  plot.ctx.font = axis.font[0];
  const widths = (texts ?? []).map((text) => plot.ctx.measureText(text).width / devicePixelRatio);
  plot.ctx.restore();
  return Math.ceil(Math.max(kLeastAxisWidth, Math.max(0, ...widths) + axis.ticks.size + axis.gap));
}

function axisOptions(label, isY) {
  const soft = paletteColour("soft");
  const grid = paletteColour("grid");
  return {
    label,
    stroke: soft,
    font: "12px system-ui, sans-serif",
    labelFont: "12px system-ui, sans-serif",
    grid: {stroke: grid, width: 1},
    ticks: {stroke: grid, width: 1},
    size: isY ? axisWidth : 38,
    labelSize: 18,
    values: (_, splits) => splits.map((value) => value === null ? "" : tickText(value)),
  };
}

// A number on an axis: powers of ten that are written out are written shortly.
function tickText(value) {
  return formatNumber(Number(value.toPrecision(12))).replace(/^(−?)1 × /, "$1");
}

// Of a logarithmic axis, the decades alone, and of many of them every second, third, …
function decadesOnly(_, splits) {
  const exponents = splits.map((value) => Math.log10(value));
  const every = Math.ceil((exponents.at(-1) - exponents[0]) / kMostDecades) || 1;
  return splits.map((value, i) => {
    const nearest = Math.round(exponents[i]);
    return Math.abs(exponents[i] - nearest) < 1e-9 && nearest % every === 0 ? value : null;
  });
}

// The range of an axis about the data, what it must include, and its rules. A tight one ends there.
function rangeOf(includes, log, tight) {
  return (_, low, high) => {
    const values = includes.concat([low, high]).filter((v) => Number.isFinite(v) && (!log || v > 0));
    if (values.length === 0) return log ? [1e-3, 1] : [0, 1];
    const lower = Math.min(...values);
    const upper = Math.max(...values);
    if (log) {
      const decades = [Math.floor(Math.log10(lower)), Math.min(Math.ceil(Math.log10(upper)), kLastDecade)];
      return [10 ** decades[0], 10 ** Math.max(decades[1], decades[0] + 1)];
    }
    if (tight) return upper > lower ? [lower, upper] : [lower, lower + 1];
    const [a, b] = uPlot.rangeNum(lower, upper, 0.08, true);
    return [lower === 0 ? 0 : a, b];
  };
}

// Dashed lines over the whole chart.
function drawLimits(plot, rules, limits) {
  const {ctx, bbox} = plot;
  ctx.save();
  ctx.strokeStyle = paletteColour("ink");
  ctx.setLineDash([3, 4]);
  ctx.lineWidth = Math.max(1.2 * devicePixelRatio, 1);
  const line = (x0, y0, x1, y1) => {
    ctx.beginPath();
    ctx.moveTo(x0, y0);
    ctx.lineTo(x1, y1);
    ctx.stroke();
  };
  for (const rule of rules) {
    const y = plot.valToPos(rule, "y", true);
    if (y >= bbox.top && y <= bbox.top + bbox.height) line(bbox.left, y, bbox.left + bbox.width, y);
  }
  for (const limit of limits) {
    const x = plot.valToPos(limit, "x", true);
    if (x >= bbox.left && x <= bbox.left + bbox.width) line(x, bbox.top, x, bbox.top + bbox.height);
  }
  ctx.restore();
}

function plotOptions(chart, width, sync, valueAt) {
  const log = chart.yScale === "log";
  const logX = chart.xScale === "log";
  const rules = chart.rules.map((rule) => rule.value).filter(Number.isFinite);
  const limits = chart.series.map(verticalLimit).filter((limit) => limit !== null);
  const allX = rangeOf(chart.xIncludes.concat(limits), logX, true);
  // What is dragged is shown as it is; else everything.
  const xRange = (plot, low, high) => {
    const row = plot.data[0];
    return low > row[0] || high < row[row.length - 1] ? [low, high] : allX(plot, low, high);
  };
  const narrow = width < kNarrow;
  const x = axisOptions(chart.xLabel, false);
  const y = axisOptions(chart.yLabel, true);
  x.space = narrow ? 60 : 50;
  if (log) y.filter = y.grid.filter = y.ticks.filter = decadesOnly;
  return {
    width,
    height: kChartHeight,
    cursor: {
      y: false,
      focus: {prox: 24},
      drag: {x: true, y: false, uni: 20},
      sync: sync ? {key: "drive", setSeries: false} : undefined,
    },
    scales: {
      x: {time: false, distr: logX ? 3 : 1, range: xRange},
      y: {distr: log ? 3 : 1, range: rangeOf(chart.yIncludes.concat(rules), log, false)},
    },
    axes: [x, y],
    series: [{label: chart.xLabel, value: (_, v) => v === null ? "–" : formatNumber(v, 4)},
             ...chart.series.map((series) => seriesOptions(series, valueAt))],
    legend: {live: sync},
    hooks: {draw: [(plot) => drawLimits(plot, rules, limits)]},
  };
}

// The index of the last x that is not after `value`; x come as numbers of 32 bits.
function indexBefore(row, value) {
  const last = value + 1e-6 + 1e-7 * Math.abs(value);
  let low = 0;
  let high = row.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (row[middle] <= last) low = middle; else high = middle - 1;
  }
  return low;
}

// One chart in its figure, in place of the drawing there. `rows` are those of alignedRows.
// `onPick(x)` is called where it is clicked; without it the chart has no moment.
class LiveChart {
  constructor(figure, chart, rows, onPick) {
    this.chart = chart;
    this.rows = rows;  // what is read; drawnRows says what is drawn
    this.onPick = onPick;
    this.host = document.createElement("div");
    this.host.className = "plot";
    figure.append(this.host);
    figure.classList.add("live");
    this.build();
    new ResizeObserver(() => this.fit()).observe(this.host);
  }

  build() {
    if (this.plot) this.plot.destroy();
    const width = Math.max(this.host.clientWidth, 200);
    const options = plotOptions(this.chart, width, Boolean(this.onPick),
                                (place, index) => this.rows[place][index]);
    options.hooks.ready = [() => queueMicrotask(() => this.show(this.shown))];
    this.plot = new uPlot(options, drawnRows(this.chart, this.rows), this.host);
    if (!this.onPick) return;
    this.line = document.createElement("div");
    this.line.className = "moment";
    this.plot.over.append(this.line);
    let pressed = 0;
    this.plot.over.addEventListener("mousedown", (event) => { pressed = event.clientX; });
    this.plot.over.addEventListener("click", (event) => {
      if (Math.abs(event.clientX - pressed) < 4) this.onPick(this.plot.posToVal(event.offsetX, "x"));
    });
    this.plot.over.addEventListener("mouseleave", () => this.show(this.shown));
  }

  fit() {
    const width = this.host.clientWidth;
    if (width > 0 && Math.abs(width - this.plot.width) > 1) {
      this.plot.setSize({width, height: kChartHeight});
      this.show(this.shown);
    }
  }

  // Puts the mark of the moment to x, and the values there into the legend.
  show(x) {
    if (!this.onPick || x === undefined) return;
    this.shown = x;
    const at = this.plot.valToPos(x, "x");
    this.line.hidden = !(at >= 0 && at <= this.plot.over.clientWidth);
    this.line.style.left = `${at}px`;
    if (this.rows[0].length > 0) this.plot.setLegend({idx: indexBefore(this.rows[0], x)});
  }

  // Other values of the same series; the axes stay.
  setRows(rows) {
    this.rows = rows;
    this.plot.setData(drawnRows(this.chart, rows));
  }

  recolour() {
    this.build();
    this.show(this.shown);
  }
}
