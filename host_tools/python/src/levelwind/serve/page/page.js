// SPDX-License-Identifier: Apache-2.0
// The page draws what the server says; how old that is it finds out itself.
"use strict";

const GIVE_UP_MS = 3000;
const WINDOW_MS = 30000;
const JOG_EVERY_MS = 80;
const TREND_S = 300;

const mm = (value) => (value >= 0 ? "+" : "−") + Math.abs(value).toFixed(1);

// ---- age ----------------------------------------------------------------------------------------
// The server stamps the request that brought the data, by a clock of its own. The least that a
// message took, over the last minute or half, ties that clock to ours. So a message that was held
// up on the way is as old as it is.

let socket = null;
let stampS = null;
let offsets = [Infinity, Infinity];
let offsetsSince = 0;
let connectedAt = 0;
let isNew = true;
let reason = "connecting";

function tie(serverS) {
  const now = performance.now();
  if (now - offsetsSince > WINDOW_MS) {
    offsets = [offsets[1], Infinity];
    offsetsSince = now;
  }
  offsets[1] = Math.min(offsets[1], now - serverS * 1000);
}

function ageMs() {
  const offset = Math.min(...offsets);
  if (stampS === null || !Number.isFinite(offset)) return Infinity;
  return performance.now() - (stampS * 1000 + offset);
}

function watchAge() {
  const age = ageMs();
  const stale = age > STALE_MS;
  document.body.classList.toggle("stale", stale);
  set("age", Number.isFinite(age) ? (Math.max(0, age) / 1000).toFixed(1) + " s" : "-");
  if (stale) {
    showPermit("nodata", "?", "NO DATA");
    fill("inhibits", ["Take it as: no launch. What is shown below is old."]);
    set("nodata-reason", reason);
    letGo();
    if (socket && age > GIVE_UP_MS && performance.now() - connectedAt > GIVE_UP_MS) {
      socket.close();  // a connection that says nothing may be none
    }
  } else {
    set("nodata-reason", "");
  }
}

// ---- what is shown ------------------------------------------------------------------------------

function fill(id, lines) {
  const list = $(id);
  const text = lines.join("\n");
  if (list.dataset.text === text) return;
  list.dataset.text = text;
  list.replaceChildren(...lines.map((line) => {
    const item = document.createElement("li");
    item.textContent = line;
    return item;
  }));
}

function showPermit(state, shape, word) {
  $("permit").dataset.state = state;
  set("permit-shape", shape);
  set("permit-word", word);
}

function duration(s) {
  if (s === null) return "not known";
  if (s < 120) return s.toFixed(0) + " s ago";
  return s < 7200 ? (s / 60).toFixed(0) + " min ago" : (s / 3600).toFixed(1) + " h ago";
}

function show(view) {
  $("los").hidden = !view.los.lost;
  fill("los-lines", view.los.lines.length ? view.los.lines : ["kind not told"]);
  set("los-todo", view.los.todo);
  $("standing").hidden = !view.standing.length;
  fill("standing-lines", view.standing);
  $("fault").hidden = !view.fault;
  if (view.fault) {
    set("fault-name", view.fault.name);
    set("fault-cause", view.fault.cause);
    set("fault-remedy", view.fault.remedy);
  }
  if (ageMs() <= STALE_MS) {
    if (view.permit) showPermit("yes", "✓", "LAUNCH PERMITTED");
    else showPermit("no", "✕", "NO LAUNCH");
    fill("inhibits", view.inhibits);
  }
  set("state", view.state);
  set("state-text", view.state_text);
  set("mode", view.mode);
  showCarriage(view);
  const rope = view.rope;
  set("rope-speed", (rope.speed_m_per_s >= 0 ? "+" : "−") + Math.abs(rope.speed_m_per_s).toFixed(1) + " m/s");
  set("rope-out", rope.known ? rope.out_m.toFixed(0) + " m" + (rope.doubtful ? ", doubtful" : "") : "not known");
  set("layer", rope.known ? String(rope.layer) + (rope.doubtful ? " ?" : "") : "not known");
  set("index-age", view.indexed ? duration(view.index_age_s) : "position unknown");
  fill("notices", view.notices);
}

function showCarriage(view) {
  const [low, minus, plus, high] = view.travel_mm;
  const place = (at) => Math.max(0, Math.min(100, 100 * (at - low) / (high - low))) + "%";
  $("reversal-minus").style.left = place(minus);
  $("reversal-plus").style.left = place(plus);
  $("block").style.left = place(view.position_mm);
  $("track").classList.toggle("unknown", !view.indexed);
  set("arrow", view.direction > 0 ? "▶" : view.direction < 0 ? "◀" : "■");
  set("position", view.indexed ? mm(view.position_mm) + " mm" + (view.los.lost ? " uncertain" : "") : "unknown");
  for (const side of ["minus", "plus"]) {
    const its = view.switches[side];
    set("switch-" + side, side + ": " + its.word);
    $("switch-" + side).className = "switch" + (its.bad ? " bad" : its.on ? " on" : "");
  }
  const next = view.next_reversal;
  set("next-reversal", next ? "next reversal: " + next.side + ", in " + next.in_mm.toFixed(0) + " mm"
    : "the carriage stands");
  $("track").setAttribute("aria-label", "Carriage at " + $("position").textContent + ", " + $("next-reversal").textContent);
}

function showLog(rows) {
  $("log-rows").replaceChildren(...rows.map((cells) => row(cells)));
}

function row(cells) {
  const line = document.createElement("tr");
  line.append(...cells.map((text) => {
    const cell = document.createElement("td");
    cell.append(text);
    return cell;
  }));
  return line;
}

// ---- pictures -----------------------------------------------------------------------------------

let trend = [];

function canvas(id) {
  const at = $(id);
  const width = Math.max(1, Math.round(at.clientWidth * devicePixelRatio));
  const height = Math.max(1, Math.round(at.clientHeight * devicePixelRatio));
  if (at.width !== width || at.height !== height) { at.width = width; at.height = height; }
  const pen = at.getContext("2d");
  pen.clearRect(0, 0, width, height);
  return [pen, width, height];
}

function drawTrend(column, id) {
  const [pen, width, height] = canvas(id);
  if (!trend.length) return;
  const last = trend[trend.length - 1][0];
  const values = trend.map((point) => point[column]);
  let low = Math.min(0, ...values), high = Math.max(0, ...values);
  if (high - low < 1e-9) high = low + 1;
  const y = (value) => height - 4 - (height - 8) * (value - low) / (high - low);
  pen.strokeStyle = "#aaa";
  pen.beginPath(); pen.moveTo(0, y(0)); pen.lineTo(width, y(0)); pen.stroke();
  pen.strokeStyle = "#111";
  pen.lineWidth = 2 * devicePixelRatio;
  pen.beginPath();
  trend.forEach((point, index) => {
    const x = width * (1 - (last - point[0]) / TREND_S);
    const gap = index > 0 && point[0] - trend[index - 1][0] > 2;
    if (index === 0 || gap) pen.moveTo(x, y(point[column])); else pen.lineTo(x, y(point[column]));
  });
  pen.stroke();
  pen.lineWidth = 1;
  pen.fillStyle = "#333";
  pen.font = 12 * devicePixelRatio + "px sans-serif";
  pen.fillText(high.toFixed(0), 4, 14 * devicePixelRatio);
  pen.fillText(low.toFixed(0), 4, height - 6);
  set(id + "-now", values[values.length - 1].toFixed(1));
}

function drawTrends() {
  if ($("trends").open) [1, 2, 3].forEach((column) => drawTrend(column, "trend-" + column));
}

function drawLay(lay) {
  if (lay.why) {
    set("lay-words", lay.why);
    return;
  }
  set("lay-words", lay.turns.toFixed(0) + " turns, highest " + lay.top_mm + " mm; dark is high. Left is minus, "
    + lay.from_mm + " to " + lay.to_mm + " mm.");
  if (!$("lay").open) return;
  const cells = Uint8Array.from(atob(lay.cells), (letter) => letter.charCodeAt(0));
  const at = $("lay-field");
  at.width = lay.columns; at.height = lay.rows;
  const pen = at.getContext("2d");
  const image = pen.createImageData(lay.columns, lay.rows);
  cells.forEach((cell, index) => image.data.set([255 - cell * .85, 255 - cell * .85, 255 - cell * .85, 255], 4 * index));
  pen.putImageData(image, 0, 0);
  const [line, width, height] = canvas("lay-profile");
  line.fillStyle = "#555";
  const bar = width / lay.columns;
  lay.mean_mm.forEach((value, index) => {
    const tall = (height - 2) * value / lay.top_mm;
    line.fillRect(index * bar, height - tall, Math.ceil(bar), tall);
  });
}

// ---- the connection -----------------------------------------------------------------------------

function connect() {
  socket = new WebSocket(location.origin.replace(/^http/, "ws") + "/live");
  connectedAt = performance.now();
  isNew = true;
  socket.onmessage = (event) => hear(JSON.parse(event.data));
  socket.onclose = () => {
    letGo();
    reason = "The server does not answer.";
    socket = null;
    setTimeout(connect, RECONNECT_MS);
  };
}

function hear(said) {
  if (isNew) {  // it may be another server, with another clock; until then the old age goes on
    isNew = false;
    stampS = null;
    offsets = [Infinity, Infinity];
    offsetsSince = performance.now();
  }
  tie(said.now);
  if (said.trend) {
    trend = said.trend;
    return;
  }
  stampS = said.stamp;
  reason = said.problem || "The controller does not answer.";
  if (said.view) show(said.view);
  if (said.trend_row && (!trend.length || said.trend_row[0] > trend[trend.length - 1][0])) {
    trend.push(said.trend_row);
    while (trend[0][0] < said.trend_row[0] - TREND_S) trend.shift();
  }
  if (said.log) showLog(said.log);
  if (said.lay) drawLay(said.lay);
  $("commissioning").hidden = !said.commissioning;
  if (said.commissioning) $("commissioning").firstChild.textContent = said.commissioning;
  $("commands").hidden = !said.commands;
  $("keys").hidden = !said.open;
  $("parameter-keys").hidden = !said.open;
  $("pin-form").hidden = said.open;
  if (jogging && (!said.open || said.jog_problem)) {
    set("answer", said.jog_problem);
    letGo();
  }
  set("recorder", said.recorder
    ? said.recorder.problem || (said.recorder.recording ? "● recording this launch" : "waiting for a launch")
    : "Nothing is recorded: levelwind serve --record FILE.sqlite");
  watchAge();
}

// ---- commands -----------------------------------------------------------------------------------

async function act(body, where = "answer") {
  set(where, "…");
  const said = await ask("/api/act", body);
  set(where, said.text);
  if (where === "parameter-answer") readParameters();
  return !said.refused;
}

document.addEventListener("click", (event) => {
  const name = event.target.dataset?.act;
  if (name) act({ name }, event.target.closest("#parameters") ? "parameter-answer" : "answer");
});

$("pin-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  const said = await ask("/api/pin", { pin: $("pin").value });
  $("pin").value = "";
  set("answer", said.text);
  if (socket) socket.close();  // the new one carries the session
});

$("leave").addEventListener("click", async () => {
  set("answer", (await ask("/api/leave", {})).text);
  if (socket) socket.close();
});

$("rope-form").addEventListener("submit", (event) => {
  event.preventDefault();
  act({ name: "set_rope", metres: $("metres").value });
});

// Held by a finger or a key; let go by anything else.
let jogging = null;

function hold(button) {
  if (jogging || !socket || socket.readyState !== WebSocket.OPEN) return;
  const say = () => socket && socket.send(JSON.stringify({ jog: Number(button.dataset.jog) }));
  button.classList.add("held");
  set("answer", "");
  say();
  jogging = { button, timer: setInterval(say, JOG_EVERY_MS), topPx: button.getBoundingClientRect().top, shiftPx: 0 };
}

// What appears above a held key must not push it away from under the finger: before the browser
// looks what is under the pointer now.
new MutationObserver(() => {
  if (!jogging) return;
  const movedPx = jogging.button.getBoundingClientRect().top - jogging.topPx;
  if (Math.abs(movedPx) < 0.1) return;
  jogging.shiftPx -= movedPx;
  jogging.button.style.translate = `0 ${jogging.shiftPx}px`;
}).observe(document.body, { subtree: true, childList: true, characterData: true, attributes: true });

function letGo() {
  if (!jogging) return;
  clearInterval(jogging.timer);
  jogging.button.classList.remove("held");
  jogging.button.style.translate = "";
  jogging = null;
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ jog: 0 }));
}

for (const button of document.querySelectorAll("[data-jog]")) {
  button.addEventListener("pointerdown", (event) => { if (event.button === 0) hold(button); });
  button.addEventListener("pointerleave", letGo);
  button.addEventListener("blur", letGo);
  button.addEventListener("contextmenu", (event) => { event.preventDefault(); letGo(); });
  button.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") { letGo(); return; }
    event.preventDefault();
    if (!event.repeat) hold(button);
  });
  button.addEventListener("keyup", letGo);
}
for (const name of ["pointerup", "pointercancel", "blur", "pagehide", "offline"]) window.addEventListener(name, letGo);
document.addEventListener("visibilitychange", () => { letGo(); watchAge(); });

// ---- parameters and launches --------------------------------------------------------------------

let parameters = [];
const typed = new Map();  // and not staged yet: kept while the table is drawn again

async function readParameters() {
  const said = await ask("/api/parameters");
  if (!Array.isArray(said)) { set("parameter-answer", said.text); return; }
  parameters = said;
  showParameters();
}

function showParameters() {
  const part = $("filter").value.trim();
  const wanted = parameters.filter((point) => point.name.includes(part) && (!$("differing").checked || differs(point)));
  const typing = document.activeElement;
  const [from, to] = [typing.selectionStart, typing.selectionEnd];
  $("parameter-rows").replaceChildren(...wanted.map((point) => {
    const name = document.createElement("span");
    const text = document.createElement("small");
    text.textContent = point.text + (point.unit ? " (" + point.unit + ")" : "");
    name.append(point.name, text);
    const field = document.createElement("input");
    field.value = typed.get(point.name) ?? point.staged;
    field.dataset.name = point.name;
    field.addEventListener("input", () => {
      typed.set(point.name, field.value.trim());
      if (field.value.trim() === point.staged) typed.delete(point.name);
      showTyped();
    });
    field.setAttribute("aria-label", point.name + ", staged");
    const line = row([name, $("parameter-keys").hidden ? point.staged : field, point.active, point.stored, point.limits]);
    line.classList.toggle("differs", differs(point));
    return line;
  }));
  // Who is typing goes on in the new field.
  const again = typing.dataset?.name && $("parameter-rows").querySelector(`input[data-name=${typing.dataset.name}]`);
  if (again) {
    again.focus();
    again.setSelectionRange(from, to);
  }
}

const differs = (point) => point.staged !== point.active || point.active !== point.stored;

const showTyped = () => set("stage", "Stage what was typed (" + typed.size + ")");

$("stage").addEventListener("click", async () => {
  const values = Object.fromEntries(typed);
  if (await act({ name: "stage", values }, "parameter-answer")) typed.clear();
  showTyped();
});
$("reload").addEventListener("click", () => { typed.clear(); showTyped(); readParameters(); });
$("filter").addEventListener("input", showParameters);
$("differing").addEventListener("change", showParameters);
$("parameters").addEventListener("toggle", () => { if ($("parameters").open) readParameters(); });

async function readLaunches() {
  const said = await ask("/api/launches");
  if (!Array.isArray(said)) return;
  $("launch-rows").replaceChildren(...said.map((one) => {
    const look = document.createElement("button");
    look.textContent = "picture of " + one.id;
    look.addEventListener("click", () => {
      $("launch-picture").src = "/api/launches/" + one.id + "/picture.png";
      $("launch-picture").alt = "Launch " + one.id + ": carriage and rope speed over time";
      $("launch-picture").hidden = false;
    });
    const result = one.result;
    return row([String(one.id), one.began.replace("T", " ").slice(0, 19), (one.seconds || 0).toFixed(0),
      (result.max_rope_speed_m_per_s || 0).toFixed(1), result.launch_permit || result.cut || "running", look]);
  }));
}
$("launches").addEventListener("toggle", () => { if ($("launches").open) readLaunches(); });
setInterval(() => { if ($("launches").open) readLaunches(); }, 5000);

setInterval(watchAge, 100);
setInterval(drawTrends, 500);
watchAge();
connect();
