# The one list of the simulated winch's sources, for the host build and the firmware build.
set(LW_PLANT_SOURCES
  src/plant.c
  src/plant_bench.c
  src/plant_carriage.c
  src/plant_contacts.c
  src/plant_drum.c
  src/plant_figures.c
  src/plant_injection.c
  src/plant_random.c
  src/plant_switch.c
)
list(TRANSFORM LW_PLANT_SOURCES PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
set(LW_PLANT_INCLUDE_DIRS ${CMAKE_CURRENT_LIST_DIR}/include)
