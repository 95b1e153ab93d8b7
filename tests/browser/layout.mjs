// Finds problems in a page's layout from the boxes of its elements.

// All layout problems of the page, as sentences; runs in the page. wide: whether even scrollable
// parts must not be cut off.
export function layoutProblems({wide}) {
  const problems = [];
  const slack = 1.5;  // pixels, of rounding
  const say = (what, element) => {
    const words = (element.textContent ?? "").trim().replace(/\s+/g, " ").slice(0, 60);
    problems.push(`${what}: <${element.tagName.toLowerCase()} class="${element.getAttribute("class") ?? ""}"> ${words}`);
  };
  const isShown = (element) => element.checkVisibility({visibilityProperty: true}) &&
    element.getBoundingClientRect().width > 0;
  // Parts that may be wider than their visible area because the reader can scroll them.
  const scrolls = (element) => element.closest(".scroll, pre") !== null;

  if (document.documentElement.scrollWidth > document.documentElement.clientWidth) {
    problems.push("the page scrolls sideways");
  }

  for (const element of document.body.querySelectorAll("*")) {
    if (!isShown(element) || element.closest("svg svg") || element.closest(".u-over, .u-under")) continue;
    const box = element.getBoundingClientRect();
    const inside = element.matches(".scroll, pre") || !scrolls(element);
    if (inside && (box.left < -slack || box.right > innerWidth + slack)) say("beyond the screen", element);
    const style = getComputedStyle(element);
    const cuts = style.overflowX !== "visible" && element.clientWidth > 0 && !element.closest("svg");
    if (cuts && element.scrollWidth > element.clientWidth + slack && (wide || !scrolls(element))) {
      say("clipped", element);
    }
  }

  const panels = [...document.querySelectorAll(".card, .tile, .outcome, details")].filter(isShown);
  const outer = panels.filter((panel) => !panels.some((other) => other !== panel && other.contains(panel)));
  const meet = (a, b, by) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > by &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > by;
  outer.forEach((panel, i) => outer.slice(i + 1).forEach((other) => {
    if (meet(panel.getBoundingClientRect(), other.getBoundingClientRect(), slack)) say("overlaps another panel", panel);
  }));

  // Text stays within its panel.
  for (const panel of panels) {
    const frame = panel.getBoundingClientRect();
    const walker = document.createTreeWalker(panel, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const parent = walker.currentNode.parentElement;
      if (!walker.currentNode.data.trim() || !isShown(parent) || scrolls(parent) || parent.closest("svg, .plot")) continue;
      const range = document.createRange();
      range.selectNodeContents(walker.currentNode);
      for (const box of range.getClientRects()) {
        if (box.left < frame.left - slack || box.right > frame.right + slack || box.bottom > frame.bottom + slack) {
          say("text leaves its panel", parent);
          break;
        }
      }
    }
  }

  // Text in a drawing stays inside it and does not overlap other text.
  for (const drawing of document.querySelectorAll("svg[role=img]")) {
    if (!isShown(drawing)) continue;
    const frame = drawing.getBoundingClientRect();
    const texts = [...drawing.querySelectorAll("text")].filter((text) => isShown(text) && text.textContent.trim());
    texts.forEach((text, i) => {
      const box = text.getBoundingClientRect();
      if (box.left < frame.left - slack || box.right > frame.right + slack ||
          box.top < frame.top - slack || box.bottom > frame.bottom + slack) {
        say("text leaves its drawing", text);
      }
      for (const other of texts.slice(i + 1)) {
        // Equal texts are the outline of a text and the text itself.
        if (other.textContent !== text.textContent && meet(box, other.getBoundingClientRect(), 3)) say("texts overlap", text);
      }
    });
  }

  const hasInk = (canvas) => {
    if (canvas.width === 0 || canvas.height === 0) return false;
    const context = canvas.getContext("2d");
    // The 3D view, whose pixels episode_scene.test.mjs checks.
    if (context === null) return true;
    return context.getImageData(0, 0, canvas.width, canvas.height).data.some((byte) => byte > 0);
  };
  const isFull = (panel) => {
    if ([...panel.querySelectorAll("canvas")].some((canvas) => isShown(canvas) && hasInk(canvas))) return true;
    if ([...panel.querySelectorAll("video, tbody tr, meter, .value")].some(isShown)) return true;
    const marks = [...panel.querySelectorAll("svg[role=img] .line, svg[role=img] .points, svg[role=img] .way, svg[role=img] .free")];
    if (marks.some(isShown)) return true;
    return panel.tagName !== "FIGURE" && [...panel.querySelectorAll("p, dd, li, input, pre")].some(
      (part) => isShown(part) && (part.tagName === "INPUT" || part.textContent.trim() !== ""));
  };
  for (const panel of panels) {
    if (panel.tagName !== "DETAILS" && !isFull(panel)) say("empty panel", panel);
  }
  return problems;
}

// Rows of tiles that are less than half full.
export function lonelyTiles() {
  return [...document.querySelectorAll(".tiles")].filter((tiles) => {
    const boxes = [...tiles.children].map((tile) => tile.getBoundingClientRect());
    const last = boxes.filter((box) => box.top > boxes.at(-1).top - 2);
    const filled = last.reduce((sum, box) => sum + box.width, 0);
    return filled < 0.4 * tiles.getBoundingClientRect().width;  // gaps are not counted
  }).map((tiles) => `${tiles.children.length} tiles`);
}

// The grids of the page whose last row has an empty column; runs in the page.
export function emptyColumns() {
  return [...document.querySelectorAll(".grid")].filter((grid) => {
    const boxes = [...grid.children].filter((child) => child.checkVisibility())
      .map((child) => child.getBoundingClientRect()).filter((box) => box.width > 0);
    if (boxes.length === 0) return false;
    const last = Math.max(...boxes.map((box) => box.top));
    const right = Math.max(...boxes.filter((box) => box.top > last - 2).map((box) => box.right));
    return right < grid.getBoundingClientRect().right - 4;
  }).map((grid) => `${grid.id || grid.className}: ${grid.textContent.trim().slice(0, 40)}`);
}
