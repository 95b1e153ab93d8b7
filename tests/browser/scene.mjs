// Pictures of the 3D view, for the tests that count its pixels.

// The view at a time (s), as `{data, width, height}` with four bytes per pixel. A picture can only
// be read in the frame in which it was drawn, and is transparent in any other. A loaded machine
// leaves frames out, so the time is asked for again until one was drawn.
export async function pictureAt(page, time) {
  const patience = performance.now() + 20_000;
  for (;;) {
    const {pixels, width, height} = await readOnce(page, time);
    const data = Buffer.from(pixels, "base64");
    if (data.some((byte) => byte > 0)) return {data, width, height};
    if (performance.now() > patience) throw new Error("the view drew no frame in 20 s");
  }
}

const readOnce = (page, time) => page.evaluate((value) => new Promise((resolve) => {
  const slider = document.getElementById("time");
  slider.value = value;
  slider.dispatchEvent(new Event("input"));
  requestAnimationFrame(() => {
    const {width, height} = document.querySelector("#scene canvas");
    const copy = document.createElement("canvas");
    Object.assign(copy, {width, height});
    const context = copy.getContext("2d");
    context.drawImage(document.querySelector("#scene canvas"), 0, 0);
    const {data} = context.getImageData(0, 0, width, height);
    let text = "";
    for (let i = 0; i < data.length; i += 0x8000) text += String.fromCharCode(...data.subarray(i, i + 0x8000));
    resolve({pixels: btoa(text), width, height});
  });
}), String(time));

// Those of a picture's pixels that `holds(r, g, b)` is true of: how many there are, and their centre
// as fractions of the picture.
export function pixelsOf({data, width, height}, holds) {
  const seen = {count: 0, x: 0, y: 0};
  for (let i = 0; i < data.length; i += 4) {
    if (!holds(data[i], data[i + 1], data[i + 2])) continue;
    ++seen.count;
    seen.x += (i / 4) % width / width;
    seen.y += Math.floor(i / 4 / width) / height;
  }
  seen.x /= seen.count;
  seen.y /= seen.count;
  return seen;
}
