/** ARM MPS2 under QEMU, without a C library: vectors, memory, and semihosting for text and the exit status. */
#include "board.h"

#include <stdint.h>

enum { SYS_WRITE0 = 0x04, SYS_EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026 };

extern uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;

static void semihost(uint32_t operation, const void *argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void put(const char *text) { semihost(SYS_WRITE0, text); }

static void leave(uint32_t status) {
    const uint32_t argument[] = {APPLICATION_EXIT, status};
    for (;;) semihost(SYS_EXIT_EXTENDED, argument);
}

static void fault(void) {
    put("fault\n");
    leave(102);
}

static void reset(void) {
#if defined(__ARM_FP)
    *(volatile uint32_t *)0xe000ed88 |= 0xf << 20; /* CPACR: the FPU is on */
    __asm__ volatile("dsb\n isb");
#endif
    for (uint32_t *to = &data_start, *from = &data_load; to < &data_end;) *to++ = *from++;
    for (uint32_t *to = &bss_start; to < &bss_end;) *to++ = 0;
    leave((uint32_t)run());
}

typedef void handler(void);

__attribute__((section(".vectors"), used)) static const struct {
    const uint32_t *stack;
    handler *reset, *nmi, *faults[4], *others[9];
} vectors = {.stack = &stack_top, .reset = reset, .nmi = fault, .faults = {fault, fault, fault, fault}};
