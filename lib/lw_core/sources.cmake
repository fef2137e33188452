# The one list of the controller's sources, for the host build and the firmware build.
set(LW_CORE_SOURCES
  generated/map.c
  src/bank.c
  src/cam.c
  src/cam_table.c
  src/controller.c
  src/crc16.c
  src/device.c
  src/device_bank.c
  src/device_events.c
  src/device_line.c
  src/device_status.c
  src/encoder_index.c
  src/homing.c
  src/law.c
  src/limit_switch.c
  src/lock.c
  src/log.c
  src/motion.c
  src/move.c
  src/param_record.c
  src/params.c
  src/pdu.c
  src/pdu_data.c
  src/pdu_diagnostics.c
  src/pdu_files.c
  src/pdu_identity.c
  src/quadrature.c
  src/record.c
  src/rtu.c
  src/slave.c
  src/store.c
  src/tracking.c
)
list(TRANSFORM LW_CORE_SOURCES PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
set(LW_CORE_INCLUDE_DIRS ${CMAKE_CURRENT_LIST_DIR}/include ${CMAKE_CURRENT_LIST_DIR}/generated)
