// SPDX-License-Identifier: Apache-2.0
// Java's digitalpetri modbus as a Modbus TCP master: as read.js.

import com.digitalpetri.modbus.client.ModbusTcpClient;
import com.digitalpetri.modbus.exceptions.ModbusResponseException;
import com.digitalpetri.modbus.pdu.ReadCoilsRequest;
import com.digitalpetri.modbus.pdu.ReadDiscreteInputsRequest;
import com.digitalpetri.modbus.pdu.ReadHoldingRegistersRequest;
import com.digitalpetri.modbus.pdu.ReadInputRegistersRequest;
import com.digitalpetri.modbus.tcp.client.NettyTcpClientTransport;
import java.util.ArrayList;
import java.util.HexFormat;
import java.util.List;

class Read {
  public static void main(String[] arguments) throws Exception {
    var transport =
        NettyTcpClientTransport.create(
            config -> {
              config.setHostname("127.0.0.1");
              config.setPort(Integer.parseInt(arguments[0]));
            });
    var client = ModbusTcpClient.create(transport);
    client.connect();
    List<String> answers = new ArrayList<>();
    for (var wanted : List.of(arguments).subList(1, arguments.length)) {
      var number = wanted.split(",");
      int address = Integer.parseInt(number[1]);
      int count = Integer.parseInt(number[2]);
      String answer;
      try {
        answer =
            HexFormat.of()
                .formatHex(
                    switch (number[0]) {
                      case "1" -> client.readCoils(1, new ReadCoilsRequest(address, count)).coils();
                      case "2" ->
                          client
                              .readDiscreteInputs(1, new ReadDiscreteInputsRequest(address, count))
                              .inputs();
                      case "3" ->
                          client
                              .readHoldingRegisters(
                                  1, new ReadHoldingRegistersRequest(address, count))
                              .registers();
                      default ->
                          client
                              .readInputRegisters(1, new ReadInputRegistersRequest(address, count))
                              .registers();
                    });
      } catch (ModbusResponseException refused) {
        answer = "exception " + refused.getExceptionCode();
      }
      answers.add("\"" + answer + "\"");
    }
    System.out.println("[" + String.join(",", answers) + "]");
    client.disconnect();
    System.exit(0);
  }
}
