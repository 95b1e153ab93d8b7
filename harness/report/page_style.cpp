#include "harness/report/page_style.hpp"

namespace qsmpc {

std::string_view page_style() {
  return R"css(
:root {
  color-scheme: light dark;
  --ground: #f4f6f8; --card: #ffffff; --ink: #16202a; --soft: #55636f; --edge: #d6dde3;
  --grid: #e6ebef; --unsafe: #c9d0d7; --obstacle: #8b97a2; --free: #ffffff;
  --good: #00694c; --bad: #b03a00; --warn: #8a5a00;
  --c0: #0072b2; --c1: #d98200; --c2: #009e73; --c3: #b8568f; --c4: #d55e00; --c5: #3a9bd1;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ground: #10151a; --card: #191f26; --ink: #e8edf2; --soft: #a0adb9; --edge: #323c46;
    --grid: #2a333c; --unsafe: #39434d; --obstacle: #75828e; --free: #141a20;
    --good: #35c79b; --bad: #ff8a4d; --warn: #f0b429;
    --c0: #4fa9e6; --c1: #f0ad2e; --c2: #2fc096; --c3: #df94bf; --c4: #ff7f3f; --c5: #8fd0f5;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 20px clamp(12px, 3vw, 32px) 40px; max-width: 1320px;
  background: var(--ground); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Liberation Sans", Arial, sans-serif;
  overflow-wrap: anywhere;
}
h1 { margin: 0 0 4px; font-size: 1.7rem; line-height: 1.2; }
h2 { margin: 32px 0 12px; font-size: 1.15rem; }
h3 { margin: 0 0 4px; font-size: 1rem; }
p { margin: 6px 0; max-width: 78ch; }
a { color: var(--c0); }
.soft, .note, footer { color: var(--soft); }
.note { font-size: 0.84rem; margin: 0 0 6px; }
.kicker { color: var(--soft); font-size: 0.9rem; margin: 0 0 14px; }
.outcome {
  border: 1px solid var(--edge); border-left: 8px solid var(--warn); border-radius: 10px;
  background: var(--card); padding: 16px 20px;
}
.outcome.good { border-left-color: var(--good); }
.outcome.bad { border-left-color: var(--bad); }
.outcome p { margin: 4px 0 0; }
.badge { font-weight: 700; color: var(--warn); }
.good .badge { color: var(--good); }
.bad .badge { color: var(--bad); }
.tiles {
  display: grid; gap: 12px; margin: 16px 0 0;
  grid-template-columns: repeat(auto-fill, minmax(180px, 1fr));
}
.tile, .card {
  background: var(--card); border: 1px solid var(--edge); border-radius: 10px; padding: 12px 14px;
}
.tile { border-top-width: 3px; }
.tile.good { border-top-color: var(--good); }
.tile.bad { border-top-color: var(--bad); }
.tile.warn { border-top-color: var(--warn); }
.tile dt { font-size: 0.84rem; color: var(--soft); line-height: 1.3; }
.tile dd { margin: 4px 0 0; }
.tile .value { font-size: 1.2rem; font-weight: 650; line-height: 1.25; }
.tile.bad .value { color: var(--bad); }
.tile.warn .value { color: var(--warn); }
.tile .hint { font-size: 0.8rem; color: var(--soft); line-height: 1.35; }
.grid {
  display: grid; gap: 14px; align-items: start;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr));
}
.stack { display: grid; gap: 14px; min-width: 0; }
figure { margin: 0; min-width: 0; }
figcaption { font-weight: 650; margin-bottom: 2px; }
video { display: block; width: 100%; height: auto; border-radius: 6px; background: #000; }
.card > svg { display: block; width: 100%; height: auto; }
.clip { overflow: hidden; }
svg text { fill: var(--ink); font-size: 12.5px; font-variant-numeric: tabular-nums; }
svg text.label { fill: var(--soft); }
svg text.middle { text-anchor: middle; }
svg text.end { text-anchor: end; }
svg text.time { font-size: 12px; font-weight: 600; }
svg text.edge { stroke: var(--free); stroke-width: 3px; stroke-linejoin: round; }
.line, .rule, .axis, .grid-line, .way, .arrow, .frame, .outline, .dots, .mark { fill: none; }
.line { stroke-width: 1.9; stroke-linejoin: round; stroke-linecap: round; }
.points { fill: none; stroke-width: 6; stroke-linecap: round; }
.dash { stroke-dasharray: 7 5; stroke-linecap: butt; }
.rule { stroke: var(--ink); stroke-width: 1.4; stroke-dasharray: 2 3; }
.axis { stroke: var(--soft); stroke-width: 1; }
.grid-line { stroke: var(--grid); stroke-width: 1; }
.c0 { stroke: var(--c0); } .c1 { stroke: var(--c1); } .c2 { stroke: var(--c2); }
.c3 { stroke: var(--c3); } .c4 { stroke: var(--c4); } .c5 { stroke: var(--c5); }
.c6 { stroke: var(--ink); } .c7 { stroke: var(--soft); }
.unsafe { fill: var(--unsafe); }
.free { fill: var(--free); }
.obstacle { fill: var(--obstacle); }
.partial { fill: var(--obstacle); fill-opacity: 0.3; stroke: var(--obstacle); stroke-dasharray: 5 4; }
.area { fill: var(--c4); fill-opacity: 0.1; }
.frame { stroke: var(--soft); stroke-width: 1; }
.target { fill: var(--c2); fill-opacity: 0.18; stroke: var(--c2); stroke-width: 2; }
.way { stroke-width: 2.2; stroke-linejoin: round; stroke-linecap: round; }
.faint { stroke-width: 1.1; stroke-opacity: 0.45; }
.broken { stroke-width: 1.3; stroke-dasharray: 4 3; stroke-linecap: butt; }
.arrow { stroke-width: 2.2; stroke-linejoin: miter; }
.outline { stroke-width: 1.6; stroke-linejoin: round; stroke-linecap: round; }
.spot { stroke-width: 4; }
.dots { stroke-linecap: round; stroke-opacity: 0.6; }
.mark { stroke-width: 9; stroke-linecap: round; }
.square { stroke-linecap: square; }
.mark.edge { stroke: var(--free); stroke-width: 12; }
.legend {
  list-style: none; display: flex; flex-wrap: wrap; gap: 2px 16px; margin: 2px 0 6px; padding: 0;
  font-size: 0.84rem; color: var(--soft);
}
.legend li { display: flex; align-items: center; gap: 6px; }
.swatch { width: 28px; height: 12px; flex: none; }
.empty { color: var(--soft); font-style: italic; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; max-width: 720px; font-variant-numeric: tabular-nums; }
th, td { padding: 6px 12px 6px 0; text-align: right; border-bottom: 1px solid var(--edge); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { color: var(--soft); font-size: 0.84rem; font-weight: 600; }
table.results { max-width: none; }
.results td, .results th { vertical-align: top; }
.results .text { text-align: left; white-space: normal; }
.results td.text:last-child { color: var(--soft); font-size: 0.84rem; }
.claims {
  display: grid; gap: 12px; margin: 12px 0;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 360px), 1fr));
}
section[id] h3 { margin-top: 18px; }
nav ul { margin: 0; padding-left: 20px; }
details { margin-top: 28px; }
summary { cursor: pointer; font-weight: 650; }
pre {
  overflow-x: auto; padding: 12px 14px; border: 1px solid var(--edge); border-radius: 8px;
  background: var(--card); font: 0.84rem/1.45 ui-monospace, "Liberation Mono", Menlo, monospace;
  white-space: pre-wrap;
}
footer { margin-top: 28px; font-size: 0.84rem; }
@media (max-width: 600px) {
  h1 { font-size: 1.4rem; }
  .tiles { grid-template-columns: 1fr 1fr; }
  svg text { font-size: 14.5px; }
  th, td { padding-right: 8px; font-size: 0.84rem; }
}
@media print { body { max-width: none; } .card, .tile { break-inside: avoid; } }
)css";
}

}  // namespace qsmpc
