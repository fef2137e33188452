// SPDX-License-Identifier: Apache-2.0
// Node's modbus-serial as a Modbus TCP master: reads each "function address count" of the
// arguments, prints the answers as JSON.
"use strict";

const Modbus = require("modbus-serial");

async function main() {
  const [port, ...wanted] = process.argv.slice(2);
  const client = new Modbus();
  await client.connectTCP("127.0.0.1", { port: Number(port) });
  client.setID(1);
  client.setTimeout(3000);
  const read = {
    1: (a, n) => client.readCoils(a, n),
    2: (a, n) => client.readDiscreteInputs(a, n),
    3: (a, n) => client.readHoldingRegisters(a, n),
    4: (a, n) => client.readInputRegisters(a, n),
  };
  const answers = [];
  for (const one of wanted) {
    const [functionCode, address, count] = one.split(",").map(Number);
    try {
      answers.push((await read[functionCode](address, count)).buffer.toString("hex"));
    } catch (error) {
      answers.push("exception " + error.modbusCode);
    }
  }
  console.log(JSON.stringify(answers));
  client.close(() => process.exit(0));
}

main();
