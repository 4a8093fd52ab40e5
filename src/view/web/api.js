// Requests to the server that this page came from.

export class Refused extends Error {
  constructor(text, status) {
    super(text);
    this.status = status;
  }
}

export function address(path, parameters = {}) {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(parameters))
    if (value !== undefined && value !== null && value !== "") query.set(name, typeof value === "boolean" ? (value ? "1" : "0") : value);
  const text = query.toString();
  return `/api/${path}${text ? `?${text}` : ""}`;
}

async function checked(response) {
  if (response.ok) return response;
  let text = `${response.status} ${response.statusText}`;
  try { text = (await response.json()).error ?? text; } catch { /* not JSON: the status must do */ }
  throw new Refused(text, response.status);
}

export async function ask(path, parameters = {}, signal) {
  return (await checked(await fetch(address(path, parameters), { signal }))).json();
}

export async function askPicture(parameters, signal) {
  const response = await checked(await fetch(address("frame", parameters), { signal }));
  const number = (name) => Number(response.headers.get(name) ?? 0);
  return {
    picture: await createImageBitmap(await response.blob()),
    samples: number("X-Samples"), done: number("X-Done") === 1, draft: number("X-Draft") === 1, milliseconds: number("X-Milliseconds"),
  };
}

export async function askReload() {
  return (await checked(await fetch("/api/reload", { method: "POST" }))).json();
}

export function save(name, blob) {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

export async function saveFile(name, path, parameters) {
  save(name, await (await checked(await fetch(address(path, parameters)))).blob());
}
