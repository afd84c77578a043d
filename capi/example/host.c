#include "board.h"

#include <stdio.h>

void put(const char *text) { fputs(text, stdout); }

int main(void) { return run(); }
