/** What a program needs of the machine; host.c and mps2.c have it. */
#ifndef BOARD_H
#define BOARD_H

/** Prints a text. */
void put(const char *text);

/** The program; its result is the exit status. */
int run(void);

#endif
