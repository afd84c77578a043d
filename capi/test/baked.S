/* One mesh baked with each structure, one asset after another, then on a lattice, in pairs, and in pairs on a lattice. */
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
pairs_list:
    .incbin "pairs-list.hits"
pairs:
    .incbin "pairs.hits"
lattice_pairs:
    .incbin "lattice-pairs.hits"
end:

    .section .data.rel.ro.baked, "aw"
    .balign 8
    .global baked
baked:
#if __SIZEOF_POINTER__ == 8
    .quad list, grid, octree, kdtree, compact, bvh, dual, lattice, pairs_list, pairs, lattice_pairs, end
#else
    .long list, grid, octree, kdtree, compact, bvh, dual, lattice, pairs_list, pairs, lattice_pairs, end
#endif

    .section .note.GNU-stack, "", %progbits
