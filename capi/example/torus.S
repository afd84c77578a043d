/* The asset in flash, at a multiple of 4 bytes: extern const unsigned char torus[], torus_end[]. */
    .section .rodata.torus, "a"
    .balign 4
    .global torus, torus_end
torus:
    .incbin "torus.hits"
torus_end:

    .section .note.GNU-stack, "", %progbits
