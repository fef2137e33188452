/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A flash in RAM, written by words of 4 bytes, erased to 0xFF by pages. The power can be cut in any
 * of its operations: the writing of one word, or an erasure.
 */
#ifndef CUT_FLASH_H
#define CUT_FLASH_H

#include <stdint.h>

enum {
	CUT_FLASH_PAGE_SIZE = 0x1000,
	CUT_FLASH_PAGES = 3,
	CUT_FLASH_SIZE = CUT_FLASH_PAGE_SIZE * CUT_FLASH_PAGES,
};

/** What the operation that is cut leaves. */
enum cut {
	CUT_BEFORE,     /**< what was there */
	CUT_AFTER,      /**< what was to be */
	CUT_PARTLY,     /**< a word with some of its bits; a page whose first part is erased */
	CUT_PARTLY_2,   /**< the same; a page whose last part is erased */
	CUT_PROGRAMMED, /**< the same; a page of zeros, as which the erasure of one begins */
	CUT_GARBAGE,    /**< the same; a page of garbage */
	CUT_BEHIND,     /**< the same; a page of garbage behind some of its old beginning */
	CUT_MIXED,      /**< the same; a page of words that are old, blank, zero or garbage */
	CUTS,
};

/** The cells. */
extern uint8_t cut_flash[CUT_FLASH_SIZE];

/** What follows from the cut. */
enum cut_effect {
	CUT_POWER,  /**< nothing works until cut_flash_power_up() */
	CUT_ERROR,  /**< the operation tells of an error, and the power stays */
	CUT_SILENT, /**< it does not even tell */
};

/** Operations since cut_flash_power_up(), and among them erasures, and words that were not blank.
 */
extern unsigned int cut_flash_operations;
extern unsigned int cut_flash_erasures;
extern unsigned int cut_flash_overwrites;

/** The power is there, and stays. */
void cut_flash_power_up(void);

/**
 * Cut an operation that is to come.
 *
 * @param operation how many go before it
 */
void cut_flash_at(unsigned int operation, enum cut cut, enum cut_effect effect);

/** Numbers that are the same in every run. */
uint32_t cut_flash_random(void);

#endif /* CUT_FLASH_H */
