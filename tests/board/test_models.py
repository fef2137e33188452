# SPDX-License-Identifier: Apache-2.0
"""Each model of the board against what the reference manual RM0390 says, with no firmware in it.

The processor sleeps; registers are written as a program would, and pins looked at in virtual time.
Small programs of a few Thumb instructions try what the processor itself does.
"""

import struct

import pytest

from board.machine import IRQ0, PA, PB, PC, Board, Cut, available

pytestmark = pytest.mark.skipif(bool(available()), reason=available())

RCC, FLASH, GPIOA, GPIOB, GPIOC = 0x40023800, 0x40023C00, 0x40020000, 0x40020400, 0x40020800
TIM2, TIM3, USART1, IWDG, EXTI, SYSCFG = (
    *(0x40000000, 0x40000400, 0x40011000),
    *(0x40003000, 0x40013C00, 0x40013800),
)
SYSTICK, NVIC, SCB = 0xE000E010, 0xE000E100, 0xE000ED00
CR1, SMCR, DIER, SR, EGR, CCMR1, CCER, CNT, PSC, ARR, CCR1 = (
    *(0x00, 0x08, 0x0C, 0x10, 0x14, 0x18),
    *(0x20, 0x24, 0x28, 0x2C, 0x34),
)
HSI_HZ = 16_000_000
SECTOR6 = 0x08040000
STACK, CODE = 0x20010000, 0x08000200
WFI_LOOP = (0xBF30, 0xE7FD)  # wfi; b to it
BX_LR = 0x4770


def board(*code: int, handlers: dict[int, tuple[int, ...]] | None = None, **config: int) -> Board:
    """A board that runs these halfwords, and then sleeps; `handlers` by exception number."""
    program = bytearray(struct.pack("<128I", *[STACK, CODE | 1, *([CODE | 1] * 126)]))
    program += struct.pack(f"<{len(code) + 2}H", *code, *WFI_LOOP)
    for number, handler in (handlers or {}).items():
        program += b"\0" * (-len(program) % 4)
        struct.pack_into("<I", program, 4 * number, 0x08000000 + len(program) | 1)
        program += struct.pack(f"<{len(handler)}H", *handler)
    made = Board(bytes(program), start_s=0, **config)
    made.run_ns(10_000)
    made.poke(RCC + 0x30, 0x7)  # the ports' clocks
    made.poke(RCC + 0x40, 0xF | 1 << 28)  # TIM2 to TIM5, PWR
    made.poke(RCC + 0x44, 1 << 4 | 1 << 14)  # USART1, SYSCFG
    return made


def literal(register: int, value: int) -> tuple[int, ...]:
    """movw, movt: any value into a register below 8."""
    halves = []
    for opcode, half in ((0xF240, value & 0xFFFF), (0xF2C0, value >> 16)):
        halves.append(opcode | (half >> 12) | (half >> 11 & 1) << 10)
        halves.append((half >> 8 & 7) << 12 | register << 8 | (half & 0xFF))
    return tuple(halves)


def test_a_peripheral_without_its_clock_does_nothing_6_3_12():
    b = board()
    b.poke(RCC + 0x30, 0)
    b.poke(GPIOA, 1)
    assert "GPIOA is used without its clock" in b.complaints
    b.poke(RCC + 0x30, 1)
    assert b.peek(GPIOA) == 0xA8000000


class TestClocks:
    """RM0390, 6.2 and 6.3."""

    def test_oscillators_take_their_time_and_the_pll_makes_what_is_written(self):
        b = board()
        assert b.clock_hz(0) == HSI_HZ
        b.poke(RCC, 1 << 16)
        assert not b.peek(RCC) & 1 << 17
        b.run(0.003)
        assert b.peek(RCC) & 1 << 17
        b.poke(RCC + 0x04, 8 | 336 << 6 | 0 << 16 | 1 << 22)  # 8 MHz / 8 * 336 / 2
        b.poke(FLASH, 5)
        b.poke(RCC + 0x08, 5 << 10 | 5 << 13)  # both buses by 4
        b.poke(RCC, 1 << 16 | 1 << 24)
        b.run(0.001)
        b.poke(RCC + 0x08, 2 | 5 << 10 | 5 << 13)
        assert b.peek(RCC + 0x08) & 0xC == 8
        assert [b.clock_hz(i) for i in range(3)] == [168_000_000, 42_000_000, 42_000_000]
        assert not b.complaints

    def test_without_a_crystal_hse_never_is_ready(self):
        b = board(hse_hz=0)
        b.poke(RCC, 1 << 16)
        b.run(1)
        assert not b.peek(RCC) & 1 << 17

    def test_a_clock_that_fails_is_an_nmi_and_hsi_takes_over_6_2_7(self):
        b = board(handlers={2: (0x3701, 0xE7FE)})
        b.poke(RCC, 1 << 16 | 1 << 19)
        b.run(0.003)
        b.poke(RCC + 0x08, 1)
        assert b.clock_hz(0) == 8_000_000
        b.set_hse(0)
        assert b.clock_hz(0) == HSI_HZ
        assert b.peek(RCC + 0x0C) & 1 << 7
        b.run_ns(10_000)
        assert b.register(7) == 1

    def test_limits_of_the_buses_and_of_the_flash_are_told(self):
        b = board()
        b.poke(RCC + 0x04, 16 | 336 << 6 | 0 << 16)
        b.poke(RCC, 1 | 1 << 24)
        b.run(0.001)
        b.poke(RCC + 0x08, 2)
        assert "PCLK1 of 168000000 Hz, at most 42000000" in b.complaints
        assert "HCLK of 168000000 Hz with 0 wait states" in b.complaints

    def test_timers_run_at_twice_a_divided_bus_6_2(self):
        b = board()
        b.poke(RCC + 0x08, 5 << 10)  # APB1 by 4: 4 MHz, timers 8 MHz
        b.poke(TIM2 + CR1, 1)
        b.run_ns(1_000_000)
        assert b.peek(TIM2 + CNT) == pytest.approx(8_000, abs=2)

    def test_causes_of_a_reset_stay_until_they_are_cleared_6_3_21(self):
        b = board()
        assert b.peek(RCC + 0x74) >> 25 & 0x7F == 0b0000111
        b.poke(RCC + 0x74, 1 << 24)
        assert b.peek(RCC + 0x74) >> 25 == 0
        b.poke(SCB + 0x0C, 0x05FA0004)
        b.run_ns(1_000)
        assert b.peek(RCC + 0x74) >> 25 & 0x7F == 0b0001010


class TestPins:
    """RM0390, 7.3, 8.2.3 and 10.3."""

    def test_a_contact_reads_closed_only_with_the_pull_up_on(self):
        b = board()
        b.drive((PB, 5), None)
        assert not b.level((PB, 5))
        b.poke(GPIOB + 0x0C, 1 << 10)
        assert b.peek(GPIOB + 0x10) >> 5 & 1
        b.drive((PB, 5), 0)
        assert not b.peek(GPIOB + 0x10) >> 5 & 1

    def test_bsrr_sets_and_resets_outputs_and_set_wins(self):
        b = board()
        b.poke(GPIOA, 0xA8000000 | 1 << 2)
        b.poke(GPIOA + 0x18, 1 << 1)
        assert b.level((PA, 1))
        b.poke(GPIOA + 0x18, 1 << 17 | 1 << 1)
        assert b.level((PA, 1))
        b.poke(GPIOA + 0x18, 1 << 17)
        assert not b.level((PA, 1))

    @pytest.mark.parametrize(("rising", "falling", "pends"), [(1, 0, [1, 0]), (0, 1, [0, 1])])
    def test_exti_pends_on_the_chosen_edge_of_the_chosen_port(self, rising, falling, pends):
        b = board()
        b.poke(SYSCFG + 0x08, PB)  # line 0: port B
        b.poke(EXTI + 0x08, rising)
        b.poke(EXTI + 0x0C, falling)
        for level, pending in zip((1, 0), pends, strict=True):
            b.drive((PC, 0), level)
            assert b.peek(EXTI + 0x14) == 0
            b.drive((PB, 0), level)
            assert b.peek(EXTI + 0x14) == pending
            b.poke(EXTI + 0x14, 1)  # a 1 clears
            assert b.peek(EXTI + 0x14) == 0

    def test_exti_interrupts_only_where_imr_lets_it(self):
        b = board()
        b.poke(SYSCFG + 0x08, PB)
        b.poke(EXTI + 0x08, 1)
        b.drive((PB, 0), 0)
        b.drive((PB, 0), 1)
        assert not b.peek(NVIC + 0x100) & 1 << 6
        b.poke(EXTI, 1)
        assert b.peek(NVIC + 0x100) & 1 << 6


class TestTimers:
    """RM0390, 17.3 and 17.4."""

    def pulse(self, delay: int, length: int, run: bool = True) -> Board:
        b = board()
        b.poke(GPIOA, 0xA8000000 | 2 << 10)
        b.poke(GPIOA + 0x20, 1 << 20)
        b.poke(TIM2 + CCMR1, 7 << 4)  # PWM 2
        b.poke(TIM2 + CCR1, 0xFFFF)
        b.poke(TIM2 + CCER, 1)
        b.poke(TIM2 + CCR1, delay)
        b.poke(TIM2 + ARR, delay + length - 1)
        b.record((PA, 5))
        b.poke(TIM2 + CR1, 1 << 3 | 1 << 2 | run)
        return b

    def test_one_pulse_has_the_delay_and_the_width_that_are_written_17_3_10(self):
        b = self.pulse(16 * 5, 16 * 3)
        start_ns = b.now_ns
        b.run_ns(100_000)
        changes = b.recorded()
        assert [int(level) for level in changes["level"]] == [1, 0]
        assert [int(t) - start_ns for t in changes["time_ns"]] == pytest.approx([5000, 8000], abs=2)
        assert not b.peek(TIM2 + CR1) & 1
        assert b.peek(TIM2 + SR) & 1

    def test_an_auto_reload_of_0_blocks_the_counter_17_4_12(self):
        b = self.pulse(0, 1)
        b.run(0.01)
        assert b.peek(TIM2 + CR1) & 1
        assert not b.peek(TIM2 + SR) & 1

    def test_urs_keeps_the_flag_from_what_software_updates_17_4_1(self):
        b = board()
        b.poke(TIM2 + EGR, 1)
        assert b.peek(TIM2 + SR) & 1
        b.poke(TIM2 + SR, 0)
        b.poke(TIM2 + CR1, 1 << 2)
        b.poke(TIM2 + EGR, 1)
        assert not b.peek(TIM2 + SR) & 1

    def test_the_prescaler_counts_from_the_next_update_on_17_3_1(self):
        b = board()
        b.poke(TIM2 + CR1, 1)
        b.poke(TIM2 + PSC, 15)
        b.run_ns(100_000)
        assert b.peek(TIM2 + CNT) == pytest.approx(1600, abs=2)
        b.poke(TIM2 + EGR, 1)
        b.run_ns(100_000)
        assert b.peek(TIM2 + CNT) == pytest.approx(100, abs=1)

    def test_a_period_is_the_auto_reload_and_one(self):
        b = board()
        b.poke(TIM2 + ARR, 1599)
        b.poke(TIM2 + DIER, 1)
        b.poke(TIM2 + CR1, 1)
        b.run_ns(99_900)
        assert not b.peek(NVIC + 0x100) & 1 << 28
        b.run_ns(200)
        assert b.peek(NVIC + 0x100) & 1 << 28

    def encoder(self, mode: int = 3, filter_code: int = 0, prescaled: int = 0) -> Board:
        """TIM3 counts what stands on PA6 and PA7, which are low."""
        b = board()
        b.poke(GPIOA, 0xA8000000 | 2 << 12 | 2 << 14)
        b.poke(GPIOA + 0x20, 2 << 24 | 2 << 28)
        b.poke(TIM3 + CCMR1, 0x0101 * (1 | filter_code << 4))
        b.poke(TIM3 + SMCR, mode)
        for pin in (6, 7):
            b.drive((PA, pin), 0)
        b.poke(TIM3 + CR1, prescaled << 8 | 1)
        return b

    FORWARD = ((6, 1), (7, 1), (6, 0), (7, 0))

    @pytest.mark.parametrize(("mode", "counts"), [(1, 2), (2, 2), (3, 4)])
    def test_encoder_modes_count_both_ways_17_3_12(self, mode: int, counts: int):
        b = self.encoder(mode)
        for pin, level in 3 * self.FORWARD:
            b.drive((PA, pin), level)
        assert b.peek(TIM3 + CNT) == 3 * counts
        assert not b.peek(TIM3 + CR1) & 1 << 4
        for pin, level in 4 * [(pin, 1 - level) for pin, level in reversed(self.FORWARD)]:
            b.drive((PA, pin), level)
        assert b.peek(TIM3 + CNT) == 0x10000 - counts
        assert b.peek(TIM3 + CR1) & 1 << 4

    @pytest.mark.parametrize(("mode", "edges"), [(1, "B"), (2, "A"), (3, "AB")])
    def test_encoder_counts_the_edges_of_the_chosen_inputs_only_17_4_3(self, mode: int, edges: str):
        b = self.encoder(mode)
        for pin, level in self.FORWARD:
            before = b.peek(TIM3 + CNT)
            b.drive((PA, pin), level)
            assert b.peek(TIM3 + CNT) - before == ("AB"[pin - 6] in edges)

    def test_an_edge_and_its_reverse_take_each_other_back_table_93(self):
        b = self.encoder()
        for pin, level in self.FORWARD:
            at = b.peek(TIM3 + CNT)
            b.drive((PA, pin), level)
            assert b.peek(TIM3 + CNT) == at + 1
            b.drive((PA, pin), 1 - level)
            assert b.peek(TIM3 + CNT) == at
            b.drive((PA, pin), level)

    def test_an_input_that_is_inverted_turns_the_direction_table_93(self):
        b = self.encoder()
        b.poke(TIM3 + CR1, 0)
        b.poke(TIM3 + CCER, 1 << 1)
        b.poke(TIM3 + CR1, 1)
        for pin, level in self.FORWARD:
            b.drive((PA, pin), level)
        assert b.peek(TIM3 + CNT) == 0x10000 - 4

    def test_a_compare_matches_from_both_sides_in_encoder_mode_17_3_12(self):
        b = self.encoder()
        b.poke(TIM3 + CCR1 + 8, 2)  # CCR3 above, CCR4 below
        b.poke(TIM3 + CCR1 + 12, 0xFFFF)
        b.poke(TIM3 + SR, 0)
        flags = []
        moves = [*self.FORWARD[:2], (7, 0), (6, 0), (7, 1)]
        for pin, level in moves:  # 1, 2, 1, 0, -1
            b.drive((PA, pin), level)
            flags.append(b.peek(TIM3 + SR) >> 3 & 3)
            b.poke(TIM3 + SR, 0)
        assert flags == [0, 1, 0, 0, 2]

    def test_a_compare_that_is_set_to_the_present_count_does_not_match_by_itself(self):
        b = self.encoder()
        b.drive((PA, 6), 1)
        b.poke(TIM3 + SR, 0)
        b.poke(TIM3 + CCR1 + 8, 1)
        b.run_ns(1000)
        assert not b.peek(TIM3 + SR) & 1 << 3

    def test_a_channel_that_is_an_input_has_no_compare_17_4_7(self):
        b = self.encoder()
        b.poke(TIM3 + CCR1, 1)
        b.poke(TIM3 + SR, 0)
        b.drive((PA, 6), 1)
        assert b.peek(TIM3 + CNT) == 1
        assert not b.peek(TIM3 + SR) & 1 << 1

    # CK_INT is 16 MHz here; fDTS is that, or a quarter with CKD = 2.
    @pytest.mark.parametrize(
        ("code", "prescaled", "filter_ns"),
        [
            *((1, 0, 125), (3, 0, 500), (3, 2, 500), (4, 0, 750)),
            *((9, 0, 4000), (9, 2, 16000), (10, 0, 5000), (15, 0, 16000)),
        ],
    )
    def test_a_filter_takes_a_level_after_its_samples_only_17_4_7(
        self, code: int, prescaled: int, filter_ns: int
    ):
        b = self.encoder(3, code, prescaled)
        samples = {1: 2, 3: 8, 4: 6, 9: 8, 10: 5, 15: 8}[code]
        period_ns = filter_ns / samples
        taken_ns = (samples - 0.5) * period_ns  # an edge in the middle between two samples
        between = (b.now_ns // period_ns + samples + 1.5) * period_ns
        b.run_ns(round(between - b.now_ns))
        b.drive((PA, 6), 1)
        b.run_ns(round(taken_ns - 0.3 * period_ns))
        b.drive((PA, 6), 0)
        b.run_ns(round(filter_ns + 0.8 * period_ns))
        assert b.peek(TIM3 + CNT) == 0, "it was too short"
        b.drive((PA, 6), 1)
        b.run_ns(round(taken_ns - 0.3 * period_ns))
        assert b.peek(TIM3 + CNT) == 0, "it came too soon"
        b.run_ns(round(0.6 * period_ns))
        assert b.peek(TIM3 + CNT) == 1

    def test_a_compare_value_with_preload_waits_for_an_update_17_4_7(self):
        # One pulse that begins with its run, and a space behind it.
        b = self.pulse(0xFFFF, 1, run=False)
        b.poke(TIM2 + CCMR1, 6 << 4 | 1 << 3)  # PWM 1, preload
        b.poke(TIM2 + CCR1, 0)
        b.poke(TIM2 + ARR, 16 * 5 - 1)
        b.poke(TIM2 + CR1, 1 << 3 | 1 << 2)
        b.poke(TIM2 + EGR, 1)
        assert not b.level((PA, 5))
        b.recorded()
        b.poke(TIM2 + CCR1, 16 * 3)
        assert not b.level((PA, 5))
        b.poke(TIM2 + EGR, 1)
        start_ns = b.now_ns
        b.poke(TIM2 + CCR1, 0)
        b.poke(TIM2 + CR1, 1 << 3 | 1 << 2 | 1)
        b.run_ns(4_990)
        assert b.peek(TIM2 + CR1) & 1
        b.run_ns(20)
        assert not b.peek(TIM2 + CR1) & 1
        b.run_ns(100_000)
        changes = b.recorded()
        assert [int(level) for level in changes["level"]] == [1, 0]
        assert [int(t) - start_ns for t in changes["time_ns"]] == pytest.approx([0, 3000], abs=2)


class TestUsart:
    """RM0390, 25.4 and 25.6."""

    def port(self, baud: int = 19200, parity: bool = False, driver: bool = False) -> Board:
        b = board()
        b.poke(GPIOA, 0xA8000000 | 1 << 16 | 2 << 18 | 2 << 20)
        b.poke(GPIOA + 0x24, 7 << 4 | 7 << 8)
        b.poke(GPIOA + 0x18, driver << 8)
        b.poke(USART1 + 0x08, round(HSI_HZ / baud))
        b.poke(USART1 + 0x0C, 1 << 13 | 1 << 3 | 1 << 2 | (3 << 10 | 1 << 12 if parity else 0))
        b.line_settings(baud, "E" if parity else "N")
        return b

    def test_a_byte_takes_its_bits_at_the_rate_of_brr_25_4_4(self):
        b = self.port(9600, driver=True)
        b.poke(USART1 + 4, 0x55)
        assert b.peek(USART1) & 1 << 7  # it went on to the shift register
        b.poke(USART1 + 4, 0xAA)
        assert not b.peek(USART1) & 1 << 7
        b.run(0.0015)
        assert not b.peek(USART1) & 1 << 6
        b.run(0.001)
        assert b.peek(USART1) & 1 << 6  # complete
        first, second = b.heard()
        assert (first.value, second.value) == (0x55, 0xAA)
        assert first.end_ns - first.start_ns == pytest.approx(10e9 / 9600, rel=1e-3)
        assert second.start_ns == pytest.approx(first.end_ns, abs=2)

    def test_a_divider_above_16_bits_is_cut_off_25_6_3(self):
        b = self.port()
        b.poke(USART1 + 8, 80_000)
        assert b.peek(USART1 + 8) == 80_000 - 65_536

    def test_what_nobody_reads_is_overrun_25_4_3(self):
        b = self.port()
        b.send(b"ab")
        b.run(0.0006)
        assert b.peek(USART1) & 1 << 5
        b.run(0.001)
        assert b.peek(USART1) & 1 << 3
        assert b.peek(USART1 + 4) == ord("a")
        assert not b.peek(USART1) & (1 << 5 | 1 << 3)

    def test_parity_is_checked_and_another_rate_is_a_framing_error_25_4_7(self):
        b = self.port(parity=True)
        b.line_settings(19200, "O")
        b.send(b"a")
        b.run(0.001)
        assert b.peek(USART1) & 1
        b.peek(USART1 + 4)
        b.line_settings(9600, "E")
        b.send(b"a")
        b.run(0.002)
        assert b.peek(USART1) & 2

    def test_with_the_driver_on_nothing_is_heard_and_with_it_off_nobody_hears(self):
        b = self.port(driver=True)
        b.send(b"a")
        b.run(0.001)
        assert not b.peek(USART1) & 1 << 5
        b.poke(GPIOA + 0x18, 1 << 24)
        b.poke(USART1 + 4, 0x55)
        b.run(0.001)
        assert not b.heard()
        assert b.seen.sent_without_driver == 1


class TestFlash:
    """RM0390, 3.5."""

    def unlocked(self, **config: int) -> Board:
        b = board(**config)
        b.poke(FLASH + 4, 0x45670123)
        b.poke(FLASH + 4, 0xCDEF89AB)
        assert not b.peek(FLASH + 0x10) >> 31
        return b

    def program(self, b: Board, address: int, value: int) -> None:
        b.poke(FLASH + 0x10, 2 << 8 | 1)
        b.poke(address, value)
        b.run_ns(20_000)
        b.poke(FLASH + 0x10, 0)

    def test_programming_makes_zeros_of_ones_only(self):
        b = self.unlocked()
        self.program(b, SECTOR6, 0xFF00FF00)
        self.program(b, SECTOR6, 0x0FF00FF0)
        assert b.peek(SECTOR6) == 0x0F000F00

    def test_nothing_is_written_while_it_is_locked_or_with_another_size(self):
        b = board()
        b.poke(SECTOR6, 0)
        assert b.peek(SECTOR6) == 0xFFFFFFFF
        b = self.unlocked()
        b.poke(FLASH + 0x10, 1)  # byte by byte
        b.poke(SECTOR6, 0)
        b.run_ns(20_000)
        assert b.peek(SECTOR6) == 0xFFFFFFFF
        assert b.peek(FLASH + 0x0C) & 1 << 6

    def test_an_erasure_takes_its_time_in_which_the_processor_stands(self):
        # An endless count in r0: adds r0, #1; b to it.
        b = board(0x3001, 0xE7FD, flash_erase_us=1_000_000)
        b.poke(FLASH + 4, 0x45670123)
        b.poke(FLASH + 4, 0xCDEF89AB)
        self.program(b, SECTOR6, 0)
        b.poke(FLASH + 0x10, 2 << 8 | 6 << 3 | 2 | 1 << 16)
        before = b.register(0)
        b.run(0.99)
        assert b.peek(FLASH + 0x0C) & 1 << 16
        assert b.register(0) - before <= 2
        b.run(0.02)
        assert b.peek(SECTOR6) == 0xFFFFFFFF
        assert b.register(0) - before > 1000
        assert b.seen.stall_max_ns == pytest.approx(1e9, rel=1e-3)

    @pytest.mark.parametrize(("when", "left"), [(Cut.BEFORE, {0xFFFFFFFF}), (Cut.AFTER, {0})])
    def test_power_is_cut_before_or_after_a_word(self, when: Cut, left: set[int]):
        b = self.unlocked()
        b.cut_power(1, when)
        self.program(b, SECTOR6, 0)
        assert not b.powered
        b.power_on()
        assert b.peek(SECTOR6) in left

    def test_power_cut_in_a_word_leaves_some_of_its_bits(self):
        b = self.unlocked()
        b.cut_power(1, Cut.IN)
        self.program(b, SECTOR6, 0)
        b.power_on()
        assert b.peek(SECTOR6) not in (0, 0xFFFFFFFF)


class TestWatchdog:
    """RM0390, 20.3."""

    @pytest.mark.parametrize("lsi_hz", [17_000, 32_000, 47_000])
    def test_it_resets_after_reload_times_prescaler_of_lsi(self, lsi_hz: int):
        b = board(lsi_hz=lsi_hz)
        b.poke(IWDG, 0xCCCC)
        b.poke(IWDG, 0x5555)
        b.poke(IWDG + 4, 2)  # by 16
        b.poke(IWDG + 8, 999)
        b.run(0.01)
        assert b.peek(IWDG + 0x0C) == 0
        b.poke(IWDG, 0xAAAA)
        b.run(16_000 / lsi_hz * 0.99)
        assert b.seen.resets_watchdog == 0
        b.run(16_000 / lsi_hz * 0.02)
        assert b.seen.resets_watchdog == 1
        assert b.peek(RCC + 0x74) >> 29 & 1

    def test_without_its_key_it_takes_nothing(self):
        b = board()
        b.poke(IWDG + 8, 1)
        assert b.peek(IWDG + 8) == 0xFFF


class TestCore:
    """ARMv7-M: B1.5 (exceptions), B3.3 (SysTick), B3.4 (NVIC)."""

    COUNT_R7 = (0x3701, BX_LR)  # adds r7, #1; bx lr: r7 is not stacked

    def wake(self, b: Board) -> None:
        """End the wfi that a program begins with."""
        b.poke(NVIC, 1 << 28)
        b.poke(NVIC + 0x100, 1 << 28)
        b.run_ns(100_000)

    def test_an_interrupt_keeps_the_registers_and_comes_back(self):
        # adds r0, #1 for ever
        b = board(0x3001, 0xE7FD, handlers={IRQ0 + 28: (0x2000, *self.COUNT_R7)})
        b.poke(NVIC, 1 << 28)
        b.poke(NVIC + 0x100, 1 << 28)
        before, stack = b.register(0), b.register(13)
        b.run_ns(100_000)
        assert b.register(7) == 1
        assert b.register(0) > before  # the handler's 0 in r0 is not seen
        assert b.register(13) == stack

    def test_a_line_that_stays_up_interrupts_again(self):
        b = board(handlers={IRQ0 + 28: self.COUNT_R7})
        b.poke(NVIC, 1 << 28)
        b.poke(TIM2 + DIER, 1)
        b.poke(TIM2 + EGR, 1)
        b.run_ns(100_000)
        assert b.register(7) > 10

    def test_the_higher_priority_goes_first_and_interrupts_the_lower(self):
        # Of line 28: pends 29 and waits; r6 tells whether 29 came in between.
        wait = (
            *literal(0, NVIC + 0x100),
            *literal(1, 1 << 29),
            *(0x6001, 0xE7FF, 0x463E, BX_LR),  # interrupts come between blocks: a branch
        )
        for priority, seen in ((0x10, 1), (0x20, 0), (0x30, 0)):
            b = board(handlers={IRQ0 + 28: wait, IRQ0 + 29: self.COUNT_R7})
            b.poke(NVIC, 3 << 28)
            b.poke(NVIC + 0x300 + 28, 0x20 | priority << 8)
            b.poke(NVIC + 0x100, 1 << 28)
            b.run_ns(100_000)
            assert (b.register(7), b.register(6)) == (1, seen), f"priority {priority:#x}"

    def test_primask_and_basepri_hold_back_and_wfi_wakes_all_the_same(self):
        # cpsid i; movs r7, #0; wfi; adds r5, #1: awake; then cpsie i
        code = (0xB672, 0x2700, 0xBF30, 0x3501, 0x463E, 0xB662)
        b = board(*code, handlers={IRQ0 + 28: self.COUNT_R7})
        b.poke(NVIC, 1 << 28)
        awake = b.register(5)
        b.poke(NVIC + 0x100, 1 << 28)
        b.run_ns(100_000)
        assert b.register(5) == awake + 1
        assert b.register(6) == 0  # not before PRIMASK was cleared
        assert b.register(7) == 1

    def test_a_bad_address_is_a_bus_fault_or_where_that_is_off_a_hard_fault(self):
        code = (*literal(0, 0x60000000), 0xBF30, 0x6800)  # ldr r0, [r0] after a wfi
        for shcsr, exception in ((0, 3), (1 << 17, 5)):
            b = board(*code, handlers={exception: (0x3701, 0xE7FE), IRQ0 + 28: (BX_LR,)})
            b.poke(SCB + 0x24, shcsr)
            b.poke(NVIC, 1 << 28)
            b.poke(NVIC + 0x100, 1 << 28)
            b.run_ns(100_000)
            assert b.register(7) == 1, f"exception {exception}"
            assert b.peek(SCB + 0x38) == 0x60000000

    def test_what_follows_an_access_under_a_condition_is_done(self):
        # r2 = 0; movs r1, #1; itt ne; ldr, str in it; b to the next; movs r2, #7; str r2.
        code = (
            *literal(0, GPIOA),
            *(0x2200, 0x2101, 0xBF1C, 0x6802, 0x6002, 0xE7FF, 0x2207, 0x6142),
        )
        b = board(
            0xBF30, *literal(3, RCC + 0x30), 0x2107, 0x6019, *code, handlers={IRQ0 + 28: (BX_LR,)}
        )
        self.wake(b)
        assert b.peek(GPIOA + 0x14) == 7

    def test_svc_comes_at_once_and_returns_behind_it(self):
        b = board(0x2700, 0xDF00, 0x463E, handlers={11: self.COUNT_R7})  # svc 0; mov r6, r7
        assert (b.register(7), b.register(6)) == (1, 1)

    def test_systick_counts_down_from_its_reload_value_and_tells_once(self):
        b = board(handlers={15: self.COUNT_R7})
        b.poke(SYSTICK + 4, 15_999)
        b.poke(SYSTICK + 8, 0)
        b.poke(SYSTICK, 7)
        b.run_ns(500_000)
        assert b.peek(SYSTICK + 8) == pytest.approx(8_000, abs=20)
        assert not b.peek(SYSTICK) & 1 << 16
        b.run_ns(510_000)
        assert b.register(7) == 1
        assert b.peek(SYSTICK) & 1 << 16
        assert not b.peek(SYSTICK) & 1 << 16
        b.run(0.099)
        assert b.register(7) == 100
        b.run(0.8995)  # over a thousand periods a count more or less shows
        assert b.peek(SYSTICK + 8) == pytest.approx(16_000 - 8_160, abs=100)

    def test_time_is_instructions_times_the_factor(self):
        for permille in (1000, 1300):
            b = board(0x3001, 0xE7FD, cycles_permille=permille)
            before = b.register(0)
            b.run_ns(1_000_000)
            assert (b.register(0) - before) * 2 == pytest.approx(16_000 * 1000 / permille, rel=1e-3)
