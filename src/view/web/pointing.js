// Mouse, touch and keys on a picture become turns, moves, zooms and picks.

const turnPerHeight = 220;  // degrees

export function listen(canvas, act) {
  const down = new Map();
  let travelled = 0, spread = 0;
  const part = (event) => {
    const box = canvas.getBoundingClientRect();
    return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height, aspect: box.width / box.height, height: box.height };
  };
  const distance = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, event);
    travelled = down.size === 1 ? 0 : 1e9;
    if (down.size === 2) spread = distance();
    canvas.classList.add("dragging");
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    if (!before) return;
    const { height } = part(event);
    const dx = (event.clientX - before.clientX) / height, dy = (event.clientY - before.clientY) / height;
    travelled += Math.hypot(dx, dy) * height;
    down.set(event.pointerId, event);
    if (travelled < 4) return;
    if (down.size >= 2) {
      act.move(dx / down.size, -dy / down.size);
      const now = distance();
      if (spread > 0 && now > 0) act.zoom(spread / now, 0, 0);
      spread = now;
    } else if (event.altKey) {
      act.cut(-dy);
    } else if (event.buttons & 6 || event.shiftKey || event.ctrlKey) {
      act.move(dx, -dy);
    } else {
      act.turn(dx * turnPerHeight, dy * turnPerHeight);
    }
  });
  const up = (event) => {
    if (!down.delete(event.pointerId)) return;
    if (down.size === 0) canvas.classList.remove("dragging");
    if (event.type === "pointerup" && travelled < 4 && event.button === 0) {
      const { x, y } = part(event);
      act.pick(x, y);
    }
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const { x, y, aspect } = part(event);
    const lines = event.deltaMode === 1 ? event.deltaY * 18 : event.deltaY;
    act.zoom(Math.exp(Math.max(-0.5, Math.min(0.5, lines * 0.0015))), (x - 0.5) * aspect, 0.5 - y);
  }, { passive: false });

  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey) return;
    const arrow = arrows[event.key];
    if (arrow && event.altKey) act.cross(0.02 * arrow[0], -0.02 * arrow[1]);
    else if (arrow && event.shiftKey) act.move(-0.05 * arrow[0], -0.05 * arrow[1]);
    else if (arrow) act.turn(-6 * arrow[0], 6 * arrow[1]);
    else if (event.key === "+" || event.key === "=") act.zoom(1 / 1.15, 0, 0);
    else if (event.key === "-" || event.key === "_") act.zoom(1.15, 0, 0);
    else if (event.key === "Home") act.home();
    else if (event.key === "PageUp") act.cut(0.04);
    else if (event.key === "PageDown") act.cut(-0.04);
    else if (event.key === "Enter" || event.key === " ") act.pickAtCross();
    else if (event.key === "Escape") act.forget();
    else if (event.key.toLowerCase() === "n") act.step(1);
    else if (event.key.toLowerCase() === "p") act.step(-1);
    else if (event.key.toLowerCase() === "f") act.goTo();
    else return;
    event.preventDefault();
  });
}
