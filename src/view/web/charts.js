// Histogram and vertical profile, drawn on a canvas of any size.

export function short(value) {
  if (value === 0 || value === null || value === undefined) return value === 0 ? "0" : "–";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}

function ticks(low, high, wanted) {
  const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough)), f = rough / power;
  const step = power * (f < 1.5 ? 1 : f < 3.5 ? 2 : f < 7.5 ? 5 : 10), out = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(Number((i * step).toPrecision(12)));
  return out;
}

function begin(canvas, theme) {
  const ratio = theme.ratio ?? (window.devicePixelRatio || 1);
  const width = theme.width ?? Math.max(200, canvas.clientWidth), height = theme.height ?? Math.max(120, canvas.clientHeight);
  canvas.width = width * ratio, canvas.height = height * ratio;
  const c = canvas.getContext("2d");
  c.scale(ratio, ratio);
  c.fillStyle = theme.paper;
  c.fillRect(0, 0, width, height);
  c.font = `${theme.size ?? 11}px system-ui, "DejaVu Sans", sans-serif`;
  return { c, width, height, line: (theme.size ?? 11) * 1.25 };
}

function axes({ c, width, height, line }, theme, x, y, xTitle, yTitle) {
  const labels = y.ticks.map(short);
  const left = Math.ceil(Math.max(...labels.map((t) => c.measureText(t).width), 10)) + 8, bottom = height - 2.3 * line, top = 1.5 * line, right = width - 12;
  const px = (v) => left + ((v - x.low) / (x.high - x.low)) * (right - left), py = (v) => bottom - ((v - y.low) / (y.high - y.low)) * (bottom - top);
  c.strokeStyle = theme.line, c.fillStyle = theme.ink, c.lineWidth = 1;
  c.textAlign = "right", c.textBaseline = "middle";
  y.ticks.forEach((v, i) => {
    c.beginPath(), c.moveTo(left, py(v)), c.lineTo(right, py(v)), c.stroke();
    c.fillText(labels[i], left - 4, py(v));
  });
  c.textAlign = "center", c.textBaseline = "top";
  x.ticks.forEach((v) => c.fillText(short(v), px(v), bottom + 3));
  c.fillText(xTitle, 0.5 * (left + right), bottom + 1.2 * line);
  c.textAlign = "left";
  c.fillText(yTitle, 2, 2);
  return { px, py, left, right, top, bottom };
}

export function titleOf(statistics) {
  const [name, ...unit] = statistics.title ?? ["value"];
  return unit.length ? `${name} [${unit.at(-1)}]` : name;
}

export function drawHistogram(canvas, statistics, theme) {
  const frame = begin(canvas, theme), { c } = frame, area = statistics.histogram.area;
  if (!area.length) return;
  const most = Math.max(...area, 1e-30), y = { low: 0, high: most * 1.05, ticks: ticks(0, most * 1.05, 3) };
  const names = statistics.categories.length > 0;
  const edges = names ? area.map((_, i) => i).concat(area.length) : statistics.histogram.edges;
  const x = { low: edges[0], high: edges.at(-1), ticks: names ? [] : ticks(edges[0], edges.at(-1), 5) };
  const { px, py, bottom } = axes(frame, theme, x, y, titleOf(statistics), "area [m²]");
  c.fillStyle = theme.accent;
  area.forEach((a, i) => c.fillRect(px(edges[i]), py(a), Math.max(1, px(edges[i + 1]) - px(edges[i]) - 1), bottom - py(a)));
  if (!names) return;
  c.fillStyle = theme.ink, c.textAlign = "center", c.textBaseline = "top";
  if (area.length <= 8) statistics.categories.forEach((name, i) => c.fillText(name, px(i + 0.5), bottom + 3, px(1) - px(0) - 2));
}

export function drawProfile(canvas, statistics, theme) {
  const frame = begin(canvas, theme), { c } = frame, { height, area, mean } = statistics.profile;
  if (!height.length) return;
  const shown = mean.length ? mean : area, title = mean.length ? `mean ${titleOf(statistics)}` : "area [m²]";
  const values = shown.filter((v) => v !== null), low = Math.min(0, ...values), high = Math.max(...values, low + 1e-30);
  const x = { low, high: high + 0.05 * (high - low), ticks: ticks(low, high, 5) };
  const y = { low: height[0], high: height.at(-1), ticks: ticks(height[0], height.at(-1), 4) };
  const { px, py } = axes(frame, theme, x, y, `${title}; pale: area`, "height [m]");
  const most = Math.max(...area, 1e-30);
  c.fillStyle = theme.pale;
  area.forEach((a, i) => c.fillRect(px(x.low), py(height[i + 1]), ((px(x.high) - px(x.low)) * a) / most, py(height[i]) - py(height[i + 1]) - 1));
  c.strokeStyle = theme.accent, c.fillStyle = theme.accent, c.lineWidth = 2, c.lineJoin = "round";
  c.beginPath();
  let open = false;
  shown.forEach((v, i) => {
    if (v === null) { open = false; return; }
    const at = [px(v), py(0.5 * (height[i] + height[i + 1]))];
    if (open) c.lineTo(...at); else c.moveTo(...at);
    open = true;
  });
  c.stroke();
  shown.forEach((v, i) => { if (v !== null) c.beginPath(), c.arc(px(v), py(0.5 * (height[i] + height[i + 1])), 2.5, 0, 7), c.fill(); });
}

export function themeOf(element) {
  const style = getComputedStyle(element), get = (name) => style.getPropertyValue(name).trim();
  return { paper: get("--panel"), ink: get("--ink"), line: get("--line"), accent: get("--accent"), pale: get("--line") };
}

/// For papers: dark on white, large, whatever the page looks like.
export const printTheme = { paper: "#ffffff", ink: "#1c211d", line: "#d3d8d2", accent: "#00704f", pale: "#cfe4d9", width: 800, height: 500, ratio: 2, size: 15 };
