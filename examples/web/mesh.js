// Mesh files as the words that the engine takes (see src/message.rs). The browser's own parsers of numbers, JSON and base64
// do the work: a crate for each format would double the module.

const MOST_BYTES = 64 << 20;
const MOST_TRIANGLES = 300_000;

/** What is wrong with a file, as a sentence for people. */
class Refusal extends Error {}

/** Reads a file by the ending of its name. */
export async function readMesh(file) {
    const ending = file.name.split(".").pop().toLowerCase();
    const read = { obj: readObj, stl: readStl, gltf: readGltf, glb: readGltf }[ending];
    if (!read) {
        throw new Refusal("Use a file that ends in .obj, .stl, .gltf or .glb.");
    }
    if (file.size > MOST_BYTES) {
        throw new Refusal(`It has ${Math.round(file.size / 1e6)} MB; this page takes ${MOST_BYTES >> 20}. The command line takes any size.`);
    }
    const mesh = new Mesh();
    try {
        read(await file.arrayBuffer(), mesh);
    } catch (error) {
        const what = { obj: "an OBJ", stl: "an STL", gltf: "a glTF", glb: "a glTF" }[ending];
        throw error instanceof Refusal ? error : new Refusal(`It is not ${what} file, or damaged (${error.message}).`);
    }
    return mesh.words();
}

/** Triangles as they are found. */
class Mesh {
    vertices = [];
    corners = [];
    materials = [];
    numbers = [];
    up = 1;

    vertex(x, y, z) {
        if (![x, y, z].every((value) => Number.isFinite(Math.fround(value)))) {
            throw new Refusal(`Vertex ${this.vertices.length / 3 + 1} has a coordinate that is no number.`);
        }
        this.vertices.push(x, y, z);
    }

    /** A fan around the first corner; what has fewer than three is no face. */
    face(corners, material = 0) {
        for (let i = 2; i < corners.length; i += 1) {
            this.corners.push(corners[0], corners[i - 1], corners[i]);
            this.numbers.push(material);
        }
        if (this.numbers.length > MOST_TRIANGLES) {
            throw new Refusal(`It has more than ${MOST_TRIANGLES.toLocaleString("en")} triangles, which would take this page too long. The command line takes any number.`);
        }
    }

    /** Linear red, green, blue; how much it mirrors. */
    material([red, green, blue], mirror = 0.05) {
        this.materials.push(red, green, blue, 0.3, 0.3, 0.3, 50, mirror);
        return this.materials.length / 8 - 1;
    }

    words() {
        const { vertices, corners, materials, numbers, up } = this;
        const highest = vertices.length / 3;
        const stray = corners.find((corner) => !(corner >= 0 && corner < highest));
        if (stray !== undefined) {
            throw new Refusal(`A face names vertex ${stray + 1} of ${highest}.`);
        }
        const ids = materials.length ? numbers : [];
        const words = new Uint32Array(4 + vertices.length + corners.length + materials.length + ids.length);
        const floats = new Float32Array(words.buffer);
        words.set([vertices.length / 3, corners.length / 3, materials.length / 8, up]);
        floats.set(vertices, 4);
        words.set(corners, 4 + vertices.length);
        floats.set(materials, 4 + vertices.length + corners.length);
        words.set(ids, 4 + vertices.length + corners.length + materials.length);
        return words;
    }
}

/** Wavefront OBJ: vertices and faces; the rest is for others. */
function readObj(buffer, mesh) {
    for (const line of new TextDecoder().decode(buffer).split("\n")) {
        const [keyword, ...words] = line.trim().split(/\s+/);
        if (keyword === "v") {
            const [x, y, z] = words.map(Number);
            mesh.vertex(x, y, z);
        } else if (keyword === "f") {
            const corners = [];
            for (const word of words) {
                if (word.startsWith("#")) {
                    break;
                }
                const number = Number.parseInt(word, 10);
                if (!Number.isFinite(number) || number === 0) {
                    throw new Refusal(`“${word.slice(0, 20)}” is no corner of a face.`);
                }
                corners.push(number > 0 ? number - 1 : mesh.vertices.length / 3 + number);
            }
            mesh.face(corners);
        }
    }
}

/** STL, binary if the length says so, else as text; z is up. */
function readStl(buffer, mesh) {
    mesh.up = 2;
    const view = new DataView(buffer);
    const count = buffer.byteLength >= 84 ? view.getUint32(80, true) : -1;
    if (buffer.byteLength === 84 + 50 * count) {
        for (let triangle = 0; triangle < count; triangle += 1) {
            for (let corner = 0; corner < 3; corner += 1) {
                const at = 84 + 50 * triangle + 12 + 12 * corner;
                mesh.vertex(...[0, 4, 8].map((offset) => view.getFloat32(at + offset, true)));
            }
            mesh.face([3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
        }
        return;
    }
    const text = new TextDecoder().decode(buffer);
    if (!text.trimStart().startsWith("solid")) {
        throw new Refusal("It is not an STL file, or cut short.");
    }
    for (const [, words] of text.matchAll(/vertex\s+([^\n]*)/g)) {
        const [x, y, z] = words.trim().split(/\s+/).map(Number);
        mesh.vertex(x, y, z);
    }
    const vertices = mesh.vertices.length / 3;
    for (let first = 0; first + 2 < vertices; first += 3) {
        mesh.face([first, first + 1, first + 2]);
    }
}

const READERS = { 5121: ["getUint8", 1], 5123: ["getUint16", 2], 5125: ["getUint32", 4], 5126: ["getFloat32", 4] };

/** glTF 2.0, as text with buffers in it or as GLB: the triangles of the scene, where its nodes put them. */
function readGltf(buffer, mesh) {
    const [document, blob] = chunks(buffer);
    if (document.extensionsRequired?.some((name) => /draco|meshopt/.test(name))) {
        throw new Refusal("Its meshes are compressed; export it without compression.");
    }
    const buffers = (document.buffers ?? []).map(({ uri }) => {
        if (uri && !uri.startsWith("data:")) {
            throw new Refusal(`It needs the file ${uri.slice(0, 40)}; export it as one .glb file.`);
        }
        return uri ? Uint8Array.from(atob(uri.slice(uri.indexOf(",") + 1)), (letter) => letter.charCodeAt(0)) : blob;
    });
    const list = (index, width) => {
        const { bufferView, byteOffset = 0, componentType, count } = document.accessors[index];
        const part = document.bufferViews[bufferView];
        const bytes = buffers[part.buffer].subarray(part.byteOffset ?? 0).subarray(0, part.byteLength);
        const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
        const [get, size] = READERS[componentType];
        const stride = part.byteStride ?? size * width;
        const read = (n) => view[get](byteOffset + Math.floor(n / width) * stride + (n % width) * size, true);
        // Reading the last one tells whether all of them are there, before room is made for any.
        read(count * width - 1);
        return Array.from({ length: count * width }, (_, n) => read(n));
    };

    for (const { pbrMetallicRoughness: { baseColorFactor = [1, 1, 1], metallicFactor = 1 } = {} } of document.materials ?? []) {
        mesh.material(baseColorFactor.slice(0, 3).map((part) => part * 0.8), metallicFactor * 0.1 + 0.04);
    }
    const neutral = document.materials ? mesh.material([0.66, 0.6, 0.52]) : 0;
    const nodes = document.nodes ?? [];
    const scene = document.scenes?.[document.scene ?? 0];
    const stack = (scene?.nodes ?? [...nodes.keys()]).map((node) => [node, new DOMMatrixReadOnly()]);
    for (let visits = 0; stack.length; visits += 1) {
        if (visits > nodes.length) {
            throw new Refusal("Its nodes form a loop.");
        }
        const [index, parent] = stack.pop();
        const node = nodes[index];
        const world = parent.multiply(placement(node));
        stack.push(...(node.children ?? []).map((child) => [child, world]));
        for (const { attributes, indices, mode = 4, material = neutral } of document.meshes[node.mesh]?.primitives ?? []) {
            if (mode < 4) {
                continue;
            }
            const first = mesh.vertices.length / 3;
            const positions = list(attributes.POSITION, 3);
            for (let at = 0; at < positions.length; at += 3) {
                const { x, y, z } = world.transformPoint({ x: positions[at], y: positions[at + 1], z: positions[at + 2] });
                mesh.vertex(x, y, z);
            }
            const corners = (indices === undefined ? [...Array(positions.length / 3).keys()] : list(indices, 1)).map((corner) => first + corner);
            if (mode === 6) {
                mesh.face(corners, material);
            } else if (mode === 5) {
                // Every other triangle of a strip is turned, to keep the winding.
                corners.slice(2).forEach((c, n) => mesh.face([corners[n + (n & 1)], corners[n + 1 - (n & 1)], c], material));
            } else {
                for (let n = 0; n + 2 < corners.length; n += 3) {
                    mesh.face(corners.slice(n, n + 3), material);
                }
            }
        }
    }
}

/** The JSON of a glTF file, and the bytes that follow it in a GLB. */
function chunks(buffer) {
    const text = (from, length) => JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, from, length)));
    const view = new DataView(buffer);
    if (buffer.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67) {
        return [text(0, buffer.byteLength), null];
    }
    const json = view.getUint32(12, true);
    const rest = 20 + json;
    return [text(20, json), rest + 8 <= buffer.byteLength ? new Uint8Array(buffer, rest + 8, view.getUint32(rest, true)) : null];
}

/** Where a node puts what it holds. */
function placement({ matrix, translation = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale = [1, 1, 1] }) {
    if (matrix) {
        return new DOMMatrixReadOnly(matrix);
    }
    const turned = new DOMMatrixReadOnly([
        1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0,
        2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
        2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0,
        0, 0, 0, 1,
    ]);
    return new DOMMatrixReadOnly().translate(...translation).multiply(turned).scale(...scale);
}
