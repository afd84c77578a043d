/* One mesh baked with each structure, one asset after another, and last on a lattice. */
    .section .rodata.assets, "a"
    .balign 4
list:
    .incbin "list.hits"
grid:
    .incbin "grid.hits"
octree:
    .incbin "octree.hits"
kdtree:
    .incbin "kdtree.hits"
compact:
    .incbin "compact.hits"
bvh:
    .incbin "bvh.hits"
dual:
    .incbin "dual.hits"
lattice:
    .incbin "lattice.hits"
end:

    .section .data.rel.ro.baked, "aw"
    .balign 8
    .global baked
baked:
#if __SIZEOF_POINTER__ == 8
    .quad list, grid, octree, kdtree, compact, bvh, dual, lattice, end
#else
    .long list, grid, octree, kdtree, compact, bvh, dual, lattice, end
#endif

    .section .note.GNU-stack, "", %progbits
