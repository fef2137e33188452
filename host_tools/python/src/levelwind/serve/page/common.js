// SPDX-License-Identifier: Apache-2.0
// What both pages do alike.
"use strict";

const RECONNECT_MS = 500;
const STALE_MS = 1000;

const $ = (id) => document.getElementById(id);
const set = (id, text) => { const at = $(id); if (at.textContent !== text) at.textContent = text; };

async function ask(path, body) {
  try {
    const answer = await fetch(path, body === undefined ? {} : {
      method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body),
    });
    return Object.assign(await answer.json(), answer.ok ? {} : { refused: true });
  } catch {
    return { refused: true, text: "No answer from the server: it may have been done." };
  }
}
