// SPDX-License-Identifier: Apache-2.0
// Rust's tokio-modbus as a Modbus TCP master: as read.js.

use std::{env, io, net::SocketAddr};
use tokio_modbus::client::sync::tcp::connect_slave;
use tokio_modbus::prelude::*;

fn of_words(answer: Vec<u16>) -> String {
    answer.iter().map(|word| format!("{word:04x}")).collect()
}

fn of_bits(answer: Vec<bool>) -> String {
    answer
        .chunks(8)
        .map(|bits| bits.iter().rev().fold(0u8, |byte, &bit| byte << 1 | u8::from(bit)))
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

fn main() -> io::Result<()> {
    let mut arguments = env::args().skip(1);
    let port: u16 = arguments.next().expect("a port").parse().expect("a number");
    let mut client = connect_slave(SocketAddr::from(([127, 0, 0, 1], port)), Slave(1))?;
    let mut answers = Vec::new();
    for wanted in arguments {
        let number: Vec<u16> = wanted.split(',').map(|n| n.parse().expect("a number")).collect();
        let (address, count) = (number[1], number[2]);
        let answer = match number[0] {
            1 => client.read_coils(address, count).map(|said| said.map(of_bits)),
            2 => client.read_discrete_inputs(address, count).map(|said| said.map(of_bits)),
            3 => client.read_holding_registers(address, count).map(|said| said.map(of_words)),
            _ => client.read_input_registers(address, count).map(|said| said.map(of_words)),
        };
        answers.push(match answer.map_err(io::Error::other)? {
            Ok(data) => format!("\"{data}\""),
            Err(exception) => format!("\"exception {}\"", u8::from(exception)),
        });
    }
    println!("[{}]", answers.join(","));
    Ok(())
}
