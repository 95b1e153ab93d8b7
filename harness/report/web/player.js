// The slider and what follows it: map, charts, the table of the moment, and the video.

const kStageCharts = {
  "stage-certificates": {
    yLabel: "probability (–)", yScale: () => "log", least: () => 1e-9, first: 1, includes: 1,
    series: [{name: "certificate", colour: 0, of: (data) => data.certificates.value},
             {name: "published method: not a bound", colour: 3, dashed: true,
              of: (data) => data.certificates.thesis}],
  },
  "stage-budgets": {
    yLabel: "W₂ distance (state units)", yScale: (data) => data.budgetScale, least: (data) => data.leastBudget,
    first: 0, includes: 0,
    series: [{name: "total", colour: 0, of: (data) => data.budgets.total},
             {name: "belief", colour: 3, of: (data) => data.budgets.belief},
             {name: "noise", colour: 2, dashed: true, of: (data) => data.budgets.noise},
             {name: "compression", colour: 1, of: (data) => data.budgets.compression},
             {name: "model error", colour: 4, dashed: true, optional: true, of: (data) => data.budgets.model}],
  },
};

// A chart over the stages of the plan of one period; its axes show all periods.
class StageChart {
  constructor(figure, data, all) {
    // A source of error that there is none of is no line.
    const kind = {...all, series: all.series.filter((series) =>
      !series.optional || series.of(data).some((value) => value > 0))};
    this.data = data;
    this.kind = kind;
    this.count = data.horizon + 1 - kind.first;
    this.log = kind.yScale(data) === "log";
    this.least = kind.least(data);
    const extremes = kind.series.flatMap((series) => this.extremes(series.of(data)));
    const chart = {
      xLabel: "stage of the plan", yLabel: kind.yLabel, xScale: "linear", yScale: kind.yScale(data), leastY: this.least,
      xIncludes: [kind.first, data.horizon],
      yIncludes: extremes.concat(kind.includes),
      series: kind.series.map((series) => ({...series, mark: "line"})), rules: [],
    };
    figure.hidden = false;
    this.live = new LiveChart(figure, chart, this.rows(0), null);
  }

  extremes(values) {
    let low = Infinity;
    let high = -Infinity;
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, this.log ? Math.max(value, this.least) : value);
      high = Math.max(high, value);
    }
    return low <= high ? [low, high] : [];
  }

  rows(k) {
    const stages = Array.from({length: this.count}, (_, i) => this.kind.first + i);
    const value = (v) => Number.isFinite(v) ? v : null;
    return [stages, ...this.kind.series.map((series) =>
      Array.from(series.of(this.data).subarray(k * this.count, (k + 1) * this.count), value))];
  }

  show(k) { this.live.setRows(this.rows(k)); }
}

// The table of the moment: texts only, so that no name can do anything.
class MomentTable {
  constructor(list, bars, data) {
    this.list = list;
    this.bars = bars;
    this.data = data;
    this.cells = new Map();
  }

  set(name, text, key) {
    if (!this.cells.has(name)) {
      const row = document.createElement("div");
      const term = document.createElement("dt");
      const value = document.createElement("dd");
      term.textContent = name;
      value.dataset.now = key;
      row.append(term, value);
      this.list.append(row);
      this.cells.set(name, value);
    }
    this.cells.get(name).textContent = text;
  }

  // Of period k; `instant` is the last control instant that is not after `time`: the same but at the
  // end of the drive, where no period begins.
  show(k, time, instant) {
    const {data} = this;
    const stage = k * data.horizon;
    this.set("Time", `${time.toFixed(2)} s, period ${k + 1} of ${data.steps}`, "time");
    for (const input of data.inputs) {
      this.set(input.name, `${formatNumber(input.values[k])} ${input.unit}`, "input");
    }
    // What is no bound is not called one.
    const [next, plan] = data.holds ? ["P(unsafe) at the next step ≤", "P(unsafe) over the plan ≤"]
      : ["Certified, next step: not a bound", "Certified, plan: not a bound"];
    this.set(next, formatBound(data.certificates.value[stage]), "next");
    if (data.planned) this.set(plan, formatBound(data.certificates.plan[k]), "plan");
    this.set("Clearance", `${formatNumber(data.clearance[instant])} ${data.clearanceUnit}`, "clearance");
    this.set("Solve time", `${formatNumber(data.solve[k])} ms`, "solve");
    if (data.solved) this.set("Solver", data.status[k] + (data.fallback[k] ? "; the previous plan was kept" : ""), "status");
    this.showCost(k);
  }

  // What the plan pays for, which is why it is as it is.
  showCost(k) {
    const parts = Object.entries(this.data.cost).map(([name, values]) => [name, values[k]]);
    const total = parts.reduce((sum, [, value]) => sum + (Number.isFinite(value) ? value : 0), 0);
    if (this.bars.children.length === 0) {
      for (const [name] of parts) {
        const row = document.createElement("li");
        const label = document.createElement("span");
        label.textContent = name;
        row.append(label, document.createElement("meter"), document.createElement("output"));
        row.children[1].setAttribute("aria-label", name);
        this.bars.append(row);
      }
    }
    parts.forEach(([, value], i) => {
      const share = total > 0 && Number.isFinite(value) ? value / total : 0;
      const row = this.bars.children[i];
      row.children[1].value = share;
      row.children[2].textContent = `${formatNumber(value)} (${Math.round(100 * share)} %)`;
    });
  }
}

class Player {
  constructor(data) {
    this.data = data;
    this.end = data.steps * data.period;
    this.slider = document.getElementById("time");
    this.clock = document.getElementById("clock");
    this.button = document.getElementById("play");
    this.video = document.querySelector("video");
    this.table = new MomentTable(document.getElementById("now"), document.getElementById("why"), data);
    const mapFigure = document.getElementById("live-map");
    this.map = mapFigure && data.map ? new LiveMap(mapFigure, data) : null;
    const figures = document.querySelectorAll("#charts > figure");
    this.charts = data.charts.map((chart, i) => new LiveChart(
      figures[i], chart, alignedRows(chart),
      chart.xLabel.startsWith("time") ? (time) => this.seek(time) : null));
    this.stages = data.planned ? Object.entries(kStageCharts).map(([id, kind]) =>
      new StageChart(document.getElementById(id), data, kind)) : [];
    this.listen();
    for (const part of document.querySelectorAll(".needs-script")) part.hidden = false;
    this.seek(0);
  }

  listen() {
    this.slider.max = this.end;
    this.slider.step = this.data.period;
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.button.addEventListener("click", () => this.toggle());
    document.getElementById("back").addEventListener("click", () => this.step(-1));
    document.getElementById("forward").addEventListener("click", () => this.step(1));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      for (const chart of this.charts) chart.recolour();
      for (const chart of this.stages) chart.live.recolour();
    });
    if (!this.video) return;
    this.video.addEventListener("play", () => this.follow());
    this.video.addEventListener("pause", () => this.setPlaying(false));
    this.video.addEventListener("seeked", () => this.afterSeek());
  }

  // Between the drive's time and the video's, both in s: the video may show a part, and faster.
  driveTime() { return this.data.video.from + this.video.currentTime * this.data.video.speed; }
  videoTime() { return Math.max(this.time - this.data.video.from, 0) / this.data.video.speed; }

  hasVideo() { return Boolean(this.video) && this.video.readyState > 0 && !this.video.error; }

  step(periods) {
    this.seek((Math.round(this.time / this.data.period) + periods) * this.data.period);
  }

  // Shows the moment `time` (s) everywhere, in the video too.
  seek(time) {
    this.show(time);
    this.seekVideo();
  }

  // A seek that is under way is finished first: the last one wanted follows.
  seekVideo() {
    if (!this.video) return;
    if (this.video.seeking) {
      this.wanted = this.time;
      return;
    }
    this.wanted = undefined;
    const at = this.videoTime();
    if (Math.abs(this.video.currentTime - at) > 1e-3) this.video.currentTime = at;
  }

  afterSeek() {
    if (this.wanted !== undefined) {
      this.seekVideo();
    } else {
      // The video's own controls were used.
      const time = Math.min(this.driveTime(), this.end);
      if (Math.abs(time - this.time) > this.data.period) this.show(time);
    }
  }

  show(time) {
    const {data} = this;
    this.time = Math.min(Math.max(time, 0), this.end);
    const periods = this.time / data.period;
    const instant = Math.floor(periods + 1e-6);
    const k = Math.min(instant, data.steps - 1);
    const share = Math.min(Math.max(periods - k, 0), 1);
    if (this.map) this.map.show(k, share);
    // For the view in three dimensions, whose script is apart (scene3d.js).
    document.dispatchEvent(new CustomEvent("qsmpc-moment", {
      detail: {data, period: k, share, time: this.time, stageColour, wayColour, forecastEllipses,
               obstaclePose}}));
    if (k !== this.period) for (const chart of this.stages) chart.show(k);
    this.period = k;
    for (const chart of this.charts) chart.show(this.time);
    this.table.show(k, this.time, instant);
    this.slider.value = this.time;
    this.slider.setAttribute("aria-valuetext", `${this.time.toFixed(1)} s`);
    this.clock.textContent = `${this.time.toFixed(1)} s`;
  }

  setPlaying(playing) {
    this.playing = playing;
    this.button.textContent = playing ? "Pause" : "Play";
    this.button.setAttribute("aria-pressed", String(playing));
  }

  toggle() {
    if (this.playing) {
      this.setPlaying(false);
      if (this.video) this.video.pause();
      return;
    }
    if (this.time >= this.end - 1e-6) this.seek(0);
    if (this.hasVideo()) {
      this.video.play().catch(() => this.run());
    } else {
      this.run();
    }
  }

  // Everything follows the video, picture by picture.
  follow() {
    this.setPlaying(true);
    const next = () => {
      if (!this.playing) return;
      this.show(this.driveTime());
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  // Without a video the clock runs by itself.
  run() {
    this.setPlaying(true);
    const begin = performance.now() - 1e3 * this.time;
    const next = (now) => {
      if (!this.playing) return;
      this.show((now - begin) / 1e3);
      if (this.time >= this.end) this.setPlaying(false); else requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }
}

if (document.getElementById("episode-data")) new Player(readData());
