// SPDX-License-Identifier: Apache-2.0
// Go's simonvetter/modbus as a Modbus TCP master: as read.js, for the reads of registers and bits.
package main

import (
	"encoding/hex"
	"encoding/json"
	"errors"
	"fmt"
	"os"
	"time"

	"github.com/simonvetter/modbus"
)

var refusals = map[error]int{
	modbus.ErrIllegalFunction:      1,
	modbus.ErrIllegalDataAddress:   2,
	modbus.ErrIllegalDataValue:     3,
	modbus.ErrUnexpectedParameters: 3, // it refuses too many by itself
}

func words(values []uint16, err error) ([]byte, error) {
	data := []byte{}
	for _, value := range values {
		data = append(data, byte(value>>8), byte(value))
	}
	return data, err
}

func bits(values []bool, err error) ([]byte, error) {
	data := make([]byte, (len(values)+7)/8)
	for at, value := range values {
		if value {
			data[at/8] |= 1 << (at % 8)
		}
	}
	return data, err
}

func main() {
	client, err := modbus.NewClient(&modbus.ClientConfiguration{
		URL: "tcp://127.0.0.1:" + os.Args[1], Timeout: 3 * time.Second})
	if err == nil {
		err = client.Open()
	}
	if err != nil {
		panic(err)
	}
	defer client.Close()
	client.SetUnitId(1)
	answers := []string{}
	for _, wanted := range os.Args[2:] {
		var function int
		var address, count uint16
		var data []byte
		fmt.Sscanf(wanted, "%d,%d,%d", &function, &address, &count)
		switch function {
		case 1:
			data, err = bits(client.ReadCoils(address, count))
		case 2:
			data, err = bits(client.ReadDiscreteInputs(address, count))
		case 3:
			data, err = words(client.ReadRegisters(address, count, modbus.HOLDING_REGISTER))
		case 4:
			data, err = words(client.ReadRegisters(address, count, modbus.INPUT_REGISTER))
		}
		answer := hex.EncodeToString(data)
		for refusal, code := range refusals {
			if errors.Is(err, refusal) {
				answer, err = fmt.Sprintf("exception %d", code), nil
			}
		}
		if err != nil {
			panic(err)
		}
		answers = append(answers, answer)
	}
	json.NewEncoder(os.Stdout).Encode(answers)
}
