// The data of the page: a JSON object of which long rows of numbers are packed as base64.
//
//   period, steps, horizon        s; how many periods were driven; stages with a certificate
//   times, solve                  one a period: s, ms
//   clearance                     one a control instant (steps + 1), in clearanceUnit
//   holds                         whether certificates are bounds
//   cost                          {part: one a period}
//   inputs                        [{name, unit, values: one a period}]
//   certificates                  value, thesis: one a period and stage 1 … horizon; plan: a period
//   budgets                       {source: one a period and stage 0 … horizon}
//   budgetScale, leastBudget      linear or log; what is below is drawn there on the latter
//   status, fallback              one a period
//   charts                        see charts.js
//   map (where there is a plane)  xLeft, yTop, scale: plane to drawing;
//                                 poses: x, y, heading at each control instant; predicted: the same
//                                 at each period's end by the model without noise; plans: x, y by
//                                 period and stage; moments: x, y, xx, xy, yy of the particles by
//                                 period and stage; particles: see unpackParticles;
//                                 others (where obstacles move): see unpackOthers
//   video                           from: s of the drive where it begins; speed: of the drive in it

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const floatsOf = (text) => new Float32Array(bytesOf(text).buffer);
const wordsOf = (text) => new Uint16Array(bytesOf(text).buffer);

const kNowhere = 65535;
const kLastPlace = 65534;

// All particles of the drive, those of period k and stage s at starts[k (horizon + 1) + s] …
function unpackParticles(packed) {
  const counts = floatsOf(packed.counts);
  const starts = new Uint32Array(counts.length + 1);
  counts.forEach((count, i) => { starts[i + 1] = starts[i] + count; });
  const places = wordsOf(packed.places);
  const coordinate = (place, lower, upper) =>
    place === kNowhere ? NaN : lower + (upper - lower) * place / kLastPlace;
  const x = new Float32Array(places.length / 2);
  const y = new Float32Array(places.length / 2);
  for (let i = 0; i < x.length; ++i) {
    x[i] = coordinate(places[2 * i], packed.xLower, packed.xUpper);
    y[i] = coordinate(places[2 * i + 1], packed.yLower, packed.yUpper);
  }
  return {starts, x, y, sizes: bytesOf(packed.sizes), stride: packed.stride};
}

// The obstacles that move:
//   outlines   of each: x, y about its middle
//   poses      x, y of its middle, turn: by control instant and obstacle
//   ways       that all obstacles together may intend, those of one after those of the one before
//   stages     of the plan that forecasts are of; none: there are no forecasts
//   weights    by period and way: its probability, not a number without a plan
//   places     by period, way and stage: x, y, xx, xy, yy of the middle
function unpackOthers(others) {
  const some = (text) => text === undefined ? new Float32Array() : floatsOf(text);
  return {...others, outlines: others.outlines.map(floatsOf), poses: floatsOf(others.poses),
          weights: some(others.weights), places: some(others.places)};
}

function unpackMap(map) {
  return {
    ...map,
    poses: floatsOf(map.poses),
    predicted: floatsOf(map.predicted),
    plans: floatsOf(map.plans),
    moments: floatsOf(map.moments),
    particles: unpackParticles(map.particles),
    others: map.others && unpackOthers(map.others),
  };
}

const unpackAll = (object) =>
  Object.fromEntries(Object.entries(object).map(([name, text]) => [name, floatsOf(text)]));

function readData() {
  const data = JSON.parse(document.getElementById("episode-data").textContent);
  return {
    ...data,
    times: floatsOf(data.times),
    solve: floatsOf(data.solve),
    clearance: floatsOf(data.clearance),
    cost: unpackAll(data.cost),
    inputs: data.inputs.map((input) => ({...input, values: floatsOf(input.values)})),
    certificates: unpackAll(data.certificates),
    budgets: unpackAll(data.budgets),
    map: data.map && unpackMap(data.map),
  };
}

// A number as people read it, as numbers.hpp writes it.
function formatNumber(value, digits = 3) {
  if (Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const sign = value < 0 ? "−" : "";
  if (size >= 1e-3 && size < 1e5) return sign + String(Number(size.toPrecision(digits)));
  const [mantissa, exponent] = size.toExponential(digits - 1).split("e");
  const raised = String(Number(exponent)).replace("-", "⁻")
    .replace(/[0-9]/g, (d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(d)]);
  return `${sign}${Number(mantissa)} × 10${raised}`;
}

// An upper bound: rounded away from zero, it still is one.
function formatBound(value, digits = 3) {
  if (!Number.isFinite(value) || value <= 0) return formatNumber(value, digits);
  const unit = 10 ** (Math.floor(Math.log10(value)) - digits + 1);
  return formatNumber(Math.ceil(value / unit * (1 - 1e-9)) * unit, digits);
}

// The style's colour c0 … c7, as it is in light or dark.
function paletteColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
