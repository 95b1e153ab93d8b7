// The obstacles that move, at one moment of the map: where they truly are, and where the plan has
// them going.

const kForecastDeviations = 2;        // that an ellipse reaches
const kForecastOpacity = [0.9, 0.3];  // of a way that is certain: now, and at the plan's end
const kLeastForecast = 0.12;          // fainter ones would not be seen
const kLeastWay = 0.01;               // probability of a way that is drawn

// Of a way of this probability, `share` (0 … 1) of the time from now to the plan's end.
const forecastOpacity = (weight, share) => Math.max(kLeastForecast, Math.sqrt(weight) *
  (kForecastOpacity[0] + share * (kForecastOpacity[1] - kForecastOpacity[0])));

// What is drawn of the forecasts of period k: [{x, y, major, minor, angle, opacity}] of each way and
// stage, lengths in m; null where there is nothing.
function forecastEllipses({ways, stages, weights, places}, k) {
  const ellipses = [];
  for (let way = 0; way < ways; ++way) {
    const weight = weights[k * ways + way];
    stages.forEach((_, i) => {
      const at = 5 * ((k * ways + way) * stages.length + i);
      const [x, y, xx, xy, yy] = places.subarray(at, at + 5);
      const known = weight >= kLeastWay && Number.isFinite(x + y + xx + xy + yy);
      if (!known) {
        ellipses.push(null);
        return;
      }
      const {major, minor, angle} = principalAxes(xx, xy, yy);
      const share = stages.length > 1 ? i / (stages.length - 1) : 0;
      ellipses.push({x, y, major: kForecastDeviations * major, minor: kForecastDeviations * minor,
                     angle, opacity: forecastOpacity(weight, share)});
    });
  }
  return ellipses;
}

// A pose on the way from one to another one, turned the shorter way round.
function obstaclePose(others, k, n, share) {
  const count = others.outlines.length;
  const [x, y, turn, toX, toY, toTurn] = [0, 1].flatMap((next) => {
    const at = 3 * ((k + next) * count + n);
    return [...others.poses.subarray(at, at + 3)];
  });
  const by = Math.atan2(Math.sin(toTurn - turn), Math.cos(toTurn - turn));
  return [x + share * (toX - x), y + share * (toY - y), turn + share * by];
}

class LiveObstacles {
  // `map`: the LiveMap that they are drawn on, into the group `bodies` and, of the forecasts,
  // `forecasts`.
  constructor(map, others, bodies, forecasts) {
    this.map = map;
    this.others = others;
    const {scale} = map.map;
    this.bodies = others.outlines.map((outline) => {
      let data = "";
      for (let i = 0; i < outline.length; i += 2) {
        data += `${i === 0 ? "M" : "L"}${(outline[i] * scale).toFixed(2)} ${(-outline[i + 1] * scale).toFixed(2)}`;
      }
      return svgElement("path", {class: "moving", d: `${data}Z`}, bodies);
    });
    this.ellipses = Array.from({length: others.ways * others.stages.length}, () =>
      svgElement("ellipse", {class: "forecast"}, forecasts));
  }

  showForecasts(k) {
    if (this.ellipses.length === 0) return;
    const {scale} = this.map.map;
    forecastEllipses(this.others, k).forEach((ellipse, i) => {
      const element = this.ellipses[i];
      element.toggleAttribute("hidden", !ellipse);
      if (!ellipse) return;
      element.setAttribute("rx", (scale * ellipse.major).toFixed(2));
      element.setAttribute("ry", (scale * ellipse.minor).toFixed(2));
      const turn = (-ellipse.angle * 180 / Math.PI).toFixed(1);
      element.setAttribute("transform", `translate(${this.map.at(ellipse.x, ellipse.y)}) rotate(${turn})`);
      element.style.opacity = ellipse.opacity.toFixed(2);
    });
  }

  // `share` of the way through period k.
  show(k, share) {
    if (this.period !== k) {
      this.period = k;
      this.showForecasts(k);
    }
    this.bodies.forEach((body, n) => {
      const [x, y, turn] = obstaclePose(this.others, k, n, share);
      body.setAttribute("transform",
        `translate(${this.map.at(x, y)}) rotate(${(-turn * 180 / Math.PI).toFixed(1)})`);
    });
  }
}
