// SPDX-License-Identifier: Apache-2.0
// Telegraf's own configuration and its own plugin inputs.modbus: reads once what the file of the
// argument says, prints the fields as JSON.
package main

import (
	"encoding/json"
	"os"

	"github.com/influxdata/telegraf/config"
	_ "github.com/influxdata/telegraf/plugins/inputs/modbus"
	"github.com/influxdata/telegraf/testutil"
)

func check(err error) {
	if err != nil {
		panic(err)
	}
}

func main() {
	loaded := config.NewConfig()
	check(loaded.LoadConfig(os.Args[1]))
	fields := map[string]interface{}{}
	for _, input := range loaded.Inputs {
		check(input.Init())
		var gathered testutil.Accumulator
		check(input.Input.Gather(&gathered))
		check(gathered.FirstError())
		for _, metric := range gathered.Metrics {
			for name, value := range metric.Fields {
				fields[name] = value
			}
		}
	}
	check(json.NewEncoder(os.Stdout).Encode(fields))
}
