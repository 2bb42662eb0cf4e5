// Asks the server every second how its sessions fare, and shows it. Text is only ever set as text.

const PERIOD_MS = 1000;
const FULL_MS = 50; // the top of a sparkline: what a decision must stay under
const SVG = "http://www.w3.org/2000/svg";
const ORDER = ["amiss", "good", "quiet"];

const $ = (id) => document.getElementById(id);
let before = null;

function element(name, text, className = "") {
  const made = document.createElement(name);
  made.textContent = text;
  made.className = className;
  return made;
}

function sparkline(values) {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 110 28");
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", `latency of the last ${values.length} decisions`);
  const base = document.createElementNS(SVG, "line");
  for (const [key, value] of Object.entries({ x1: 0, x2: 110, y1: 27, y2: 27 })) {
    base.setAttribute(key, value);
  }
  const path = document.createElementNS(SVG, "path");
  const points = values.map((ms, index) => {
    const y = 27 - 25 * Math.min(1, ms / FULL_MS);
    return `${((index * 110) / 24).toFixed(1)},${y.toFixed(1)}`;
  });
  path.setAttribute("d", points.length > 1 ? `M${points.join("L")}` : "");
  svg.append(base, path);
  return svg;
}

const ms = (value) => (value === null ? "–" : `${value.toFixed(1)} ms`);

function rate(session, seconds) {
  const known = before?.sessions.find((one) => one.id === session.id);
  return known && seconds > 0 ? Math.max(0, session.frames - known.frames) / seconds : null;
}

function clients(session) {
  return session.clients.map((one) => {
    const trip = one.round_trip_ms === null ? "" : `, ${one.round_trip_ms.toFixed(1)} ms away`;
    const offset = one.offset_ms === null ? "" : `, clock ${(one.offset_ms / 1000).toFixed(1)} s`;
    const missed = one.missed ? `, missed ${one.missed}` : "";
    return element("small", `${one.role} ${one.client}${trip}${offset}${missed}`);
  });
}

function row(session, seconds) {
  const tr = element("tr", "", session.state);
  const name = element("td", "");
  name.append(element("span", session.id, "name"), element("small", session.words));
  const frames = rate(session, seconds);
  const latency = element("td", ms(session.p50_ms), "number");
  latency.append(element("small", `worst ${ms(session.worst_ms)}`));
  const trend = element("td", "");
  trend.append(sparkline(session.latency_ms));
  const decides = element("td", session.outcome ?? "–");
  decides.append(element("small", session.reason ?? ""));
  const agent = element("td", session.room);
  if (session.gate !== null) {
    agent.append(element("small", session.gate ? "gate open" : "gate closed"));
  }
  const connected = element("td", String(session.clients.length));
  connected.append(...clients(session));
  tr.append(
    name,
    element("td", frames === null ? "–" : frames.toFixed(0), "number"),
    latency,
    trend,
    decides,
    agent,
    element("td", String(session.commands), "number"),
    element("td", String(session.dropped), "number"),
    connected,
  );
  return tr;
}

function figure(label, value, words) {
  const card = element("div", "");
  card.append(element("dt", label), element("b", value), element("span", words));
  return card;
}

function duration(seconds) {
  const [days, hours, minutes] = [86400, 3600, 60].map((unit) => Math.floor(seconds / unit));
  if (days) return `${days} d ${hours % 24} h`;
  return hours ? `${hours} h ${minutes % 60} min` : `${minutes} min ${seconds % 60} s`;
}

function show(health) {
  const seconds = before === null ? 0 : (health.at - before.at) / 1000;
  const sessions = health.sessions;
  const amiss = sessions.filter((one) => one.state === "amiss").length;
  const decided = sessions.map((one) => one.p50_ms).filter((one) => one !== null);
  const state = $("state");
  state.textContent = health.ready ? "ready" : "not ready";
  state.className = health.ready ? "good" : "amiss";
  $("version").textContent = health.version;
  const slowest = decided.length ? Math.max(...decided) : null;
  const load = health.load === "none" ? "nothing is left out" : `left out: ${health.load}`;
  $("figures").replaceChildren(
    figure("Sessions", String(sessions.length), `of ${health.max_sessions} at most`),
    figure("Amiss", String(amiss), amiss ? "listed first" : "all are well"),
    figure("Slowest session", ms(slowest), "median from frame to decision"),
    figure("Event loop", ms(health.lag_ms), `late at worst in 10 s; ${load}`),
    figure("Memory", health.rss_mb === null ? "–" : `${health.rss_mb.toFixed(0)} MB`, "resident"),
    figure("Up", duration(health.up_s), "since the start"),
  );
  sessions.sort(
    (a, b) => ORDER.indexOf(a.state) - ORDER.indexOf(b.state) || a.id.localeCompare(b.id),
  );
  $("sessions").replaceChildren(...sessions.map((one) => row(one, seconds)));
  $("nobody").hidden = sessions.length > 0;
  $("models").textContent = Object.entries(health.models)
    .map(([name, hash]) => `${name} ${hash}`)
    .join("  ·  ");
  before = health;
}

async function look() {
  try {
    const answer = await fetch("v1/health", { cache: "no-store" });
    if (!answer.ok) {
      const told = await answer.json();
      throw new Error(told.detail ?? told.message ?? `the server answers ${answer.status}`);
    }
    show({ ...(await answer.json()), at: performance.now() });
  } catch (error) {
    $("state").textContent = error instanceof TypeError ? "the server is away" : error.message;
    $("state").className = "amiss";
  }
  setTimeout(look, PERIOD_MS);
}

look();
