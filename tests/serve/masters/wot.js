// SPDX-License-Identifier: Apache-2.0
// A consumer of the Web of Things: by a Thing Description (the first argument) it does the actions
// that are named behind it; where none is, it reads every property and prints them as JSON.
const { Servient } = require("@node-wot/core");
const { ModbusClientFactory } = require("@node-wot/binding-modbus");

(async () => {
	const description = JSON.parse(require("fs").readFileSync(process.argv[2], "utf8"));
	const servient = new Servient();
	servient.addClientFactory(new ModbusClientFactory());
	const thing = await (await servient.start()).consume(description);
	const actions = process.argv.slice(3);
	for (const name of actions) {
		await thing.invokeAction(name, true);
	}
	const values = {};
	for (const name of actions.length ? [] : Object.keys(description.properties)) {
		try {
			values[name] = await (await thing.readProperty(name)).value();
		} catch (error) {
			values[name] = error.message;
		}
	}
	console.log(JSON.stringify(values));
	process.exit(0);
})();
