// SPDX-License-Identifier: Apache-2.0
// The page draws the dialogue as the server has it, and hands on what is pressed. It decides nothing.
"use strict";

const WORDS = { y: "Yes", n: "No", g: "Go", l: "Leave it out", s: "Stop here", r: "Mended, again", done: "Done",
  pair: "NO and NC", no: "NO alone", nc: "NC alone" };

let socket = null;
let dialogue = null;
let isOpen = false;
let heardAt = 0;
let askedNumber = null;

function element(name, text, kind) {
  const made = document.createElement(name);
  made.textContent = text;
  if (kind) made.className = kind;
  return made;
}

function connect() {
  socket = new WebSocket(location.origin.replace("http", "ws") + "/commission/live");
  socket.onmessage = (event) => hear(JSON.parse(event.data));
  socket.onclose = () => { socket = null; setTimeout(connect, RECONNECT_MS); };
}

function tell(said) {
  set("answer", "");
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(said));
  else set("answer", "The server does not answer.");
}

function hear(said) {
  if (said.refused !== undefined) { set("answer", said.refused); return; }
  heardAt = performance.now();
  isOpen = said.open;
  set("problem", said.problem);
  $("problem").hidden = !said.problem;
  if (said.view && !said.problem) {
    const place = said.view.indexed ? ", " + said.view.position_mm.toFixed(1) + " mm" : ", position unknown";
    set("carriage-line", said.view.state.toUpperCase() + place);
  } else {
    set("carriage-line", "NO DATA");
  }
  if (said.dialogue) dialogue = said.dialogue;
  $("commands").hidden = isOpen;
  if (dialogue) show(dialogue);
}

// ---- what is shown ------------------------------------------------------------------------------

function show(told) {
  const at = told.steps.findIndex((step) => !step.done);
  const accepting = at < 0;
  const step = told.steps[at];
  const resumed = told.steps.some((one) => one.done);
  $("beginning").hidden = told.running;
  $("begin").disabled = !isOpen;
  set("begin", accepting && !told.accepted ? "Sign" : accepting ? "Sign again" : resumed ? "Go on with step " + (at + 1) : "Begin");
  set("ended", told.ended || (told.accepted ? "Accepted by " + told.accepted + "." : ""));
  showReports(told.reports);
  $("step").hidden = !told.running;
  if (accepting) {
    set("step-title", "Signature");
    set("step-does", "The set that is active now becomes the accepted one, and is saved. The winch then indexes.");
    showMoves("THE CARRIAGE, to both switches, once it is signed.");
    set("step-back", "Commission again.");
    showFindings([]);
  } else {
    set("step-title", at + 1 + " of " + told.steps.length + "  " + step.title);
    set("step-does", step.does);
    showMoves("What will move: " + step.moves);
    set("step-back", step.back.replaceAll("`", ""));
    showFindings(step.findings);
  }
  $("asked").hidden = !told.running;
  set("request", told.request);
  set("waiting", !told.running || told.question || told.request ? "" : "Measuring: please wait. " + (told.lines.at(-1) || "").trim());
  if (told.stopping) set("waiting", told.stopping + " Stopping.");
  if (told.running && !told.leads) set("waiting", "Another page leads this commissioning. Here it can be looked at, and stopped.");
  showQuestion(told.leads ? told.question : null);
  showSteps(told.steps, told.running ? at : -1);
  const log = told.lines.join("\n");
  if ($("said").textContent !== log) {
    $("said").textContent = log;
    $("said").scrollTop = $("said").scrollHeight;
  }
}

function showMoves(text) {
  set("step-moves", text);
  $("step-moves").classList.toggle("carriage", text.includes("THE CARRIAGE"));
}

function finding(one) {
  const block = element("div", "", one.wrong ? "finding wrong" : "finding");
  block.append(element("h3", (one.wrong ? "▲ WRONG: " : "Note: ") + one.what), element("p", (one.wrong ? "What to do: " : "") + one.remedy));
  return block;
}

// Drawn anew only where it has changed: what is under a finger or being read stays.
function redraw(at, data, draw) {
  const key = JSON.stringify(data);
  if (at.dataset.key === key) return;
  at.dataset.key = key;
  at.replaceChildren(...draw());
}

const showFindings = (findings) => redraw($("step-findings"), findings, () => findings.map(finding));

function showReports(names) {
  redraw($("reports"), names, () => names.map((name) => {
    const link = element("a", name.endsWith(".pdf") ? "Report, PDF" : "Report, HTML");
    link.href = "/commission/report/" + name;
    link.target = "_blank";
    link.rel = "noopener";
    return link;
  }));
}

function showSteps(steps, at) {
  redraw($("steps").querySelector("ol"), [steps, at], () => steps.map((step, index) => {
    const wrong = step.findings.some((one) => one.wrong);
    const leftOut = step.findings.some((one) => one.code.endsWith(".left_out"));
    const line = element("li", step.title + (leftOut ? ": – left out, not measured" : step.done ? ": ✓ done " + step.at : wrong ? ": ▲ wrong" : index === at ? ": ▶ now" : ""));
    if (index === at) line.setAttribute("aria-current", "step");
    const rows = [...step.told, ...step.measured, ...step.set.map(([name, value]) => ["set: " + name, value])];
    if (rows.length || (step.findings.length && index !== at)) {
      const more = document.createElement("details");
      const table = document.createElement("table");
      table.append(...rows.map((cells) => {
        const row = document.createElement("tr");
        row.append(...cells.map((text) => element("td", String(text))));
        return row;
      }));
      more.append(element("summary", "what was measured"), table, ...step.findings.map(finding));
      line.append(more);
    }
    return line;
  }));
}

function showQuestion(question) {
  $("question").hidden = !question;
  if (!question) { askedNumber = null; return; }
  if (question.number === askedNumber) return;
  askedNumber = question.number;
  const typed = question.kind === "number" || question.kind === "text";
  // The keys below have their own words for what the terminal abbreviates.
  set("question-text", question.name.endsWith(".begin") ? "Begin this step?" : question.name.endsWith(".again") ? "Mended?" : question.text);
  $("field").hidden = $("take").hidden = !typed;
  $("field").value = question.default;
  $("field").inputMode = question.kind === "number" ? "decimal" : "text";
  $("choices").replaceChildren(...question.choices.map((choice) => {
    const key = element("button", WORDS[choice] || choice, choice === question.default ? "default" : "");
    key.type = "button";
    key.dataset.choice = choice;
    key.addEventListener("click", () => answer(question.number, choice));
    return key;
  }));
  set("answer", "");
  if (typed) {
    $("field").focus({ preventScroll: true });
    $("field").select();
  }
  $("asked").scrollIntoView({ block: "nearest" });  // not below the fold of a phone
}

function answer(number, given) {
  tell({ number, answer: given });
}

// ---- what is pressed ----------------------------------------------------------------------------

$("question").addEventListener("submit", (event) => {
  event.preventDefault();
  if (askedNumber !== null && !$("field").hidden) answer(askedNumber, $("field").value);
});

$("begin").addEventListener("click", () => tell({ begin: true }));

$("stop").addEventListener("click", async () => {
  set("answer", "…");
  set("answer", (await ask("/api/act", { name: "stop" })).text);
});

$("pin-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  const pin = $("pin").value;
  $("pin").value = "";
  set("answer", (await ask("/api/pin", { pin })).text);
  if (socket) socket.close();  // the new one carries the session
});

setInterval(() => {
  if (performance.now() - heardAt > STALE_MS) set("carriage-line", "NO DATA: the server does not answer.");
}, 200);
connect();
