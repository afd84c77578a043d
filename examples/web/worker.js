// The worker: one instance of the module for each model and structure; draws in short turns, so that it always listens.

// How long to draw before listening again, and at most between two looks at the clock, in ms.
const TURN = 12;
const LOOK = 3;

// The compiled module, once the page sends it.
let arrived;
const module = new Promise((resolve) => { arrived = resolve; });

let engine = null; // The exports of the instance that draws.
let job = null; // The picture being drawn.
let opening = 0;

const answer = (kind, data, transfer = []) => postMessage({ kind, ...data }, transfer);

function sentence({ memory, text, text_length }) {
    return new TextDecoder().decode(new Uint8Array(memory.buffer, text(), text_length()));
}

async function open({ source, structure, preset }) {
    const turn = ++opening;
    try {
        const mesh = source.file ? await (await import("./mesh.js")).readMesh(source.file) : null;
        const { exports } = await WebAssembly.instantiate(await module);
        if (turn !== opening) {
            return; // Something else was chosen meanwhile.
        }
        const begun = performance.now();
        if (mesh) {
            // First the room: to make it may move the memory.
            const room = exports.input(mesh.length);
            new Uint32Array(exports.memory.buffer, room, mesh.length).set(mesh);
        }
        const refused = (mesh ? exports.take_message() : exports.take_built_in(source.builtIn))
            || exports.build(structure, preset);
        if (refused) {
            throw new Error(sentence(exports));
        }
        engine = exports;
        job = null;
        answer("opened", {
            source,
            primitives: exports.primitives(),
            structureBytes: exports.structure_bytes(),
            buildTime: performance.now() - begun,
        });
    } catch (error) {
        const trap = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
        const why = trap ? "The engine gave up on it, most likely for want of memory." : error.message;
        if (turn !== opening) {
            return;
        }
        answer("refused", { text: `${source.name ?? "The model"} is not shown. ${why}` });
    }
}

function draw({ picture, view }) {
    if (!engine) {
        return;
    }
    const { width, height, yaw, pitch, zoom, terms, bounces, samples, heat } = view;
    engine.begin(width, height, yaw, pitch, zoom, terms, bounces, samples, heat);
    // Blocks at a time: few at first, for nobody knows yet how long one takes.
    job = { picture, view, blocks: 64, drawn: 0, spent: 0, begun: performance.now(), pictureTime: 0 };
    if (!waiting) {
        work();
    }
}

// A message to oneself comes after those of the page, and sooner than any timer.
const again = new MessageChannel();
let waiting = false;
again.port1.onmessage = () => {
    waiting = false;
    work();
};

function work() {
    if (!job) {
        return;
    }
    const { width, height, samples, heat } = job.view;
    const begun = performance.now();
    const tiles = new Map();
    let now = begun;
    let more = true;
    while (more && now - begun < TURN) {
        const drawn = engine.step(job.blocks);
        more = drawn > 0;
        if (more) {
            job.drawn += drawn;
            const tile = { x: engine.tile_x(), y: engine.tile_y(), width: engine.tile_width(), height: engine.tile_height() };
            // Tiles of another pass may begin at the same place.
            tiles.set(`${tile.x} ${tile.y} ${tile.width} ${tile.height}`, tile);
        }
        const before = now;
        now = performance.now();
        job.blocks = Math.min(4096, Math.max(1, Math.round(job.blocks * (now - before > LOOK ? 0.5 : 2))));
        if (!job.pictureTime && job.drawn >= width * height) {
            job.pictureTime = now - job.begun;
        }
    }
    job.spent += now - begun;
    const sent = [...tiles.values()].map((tile) => ({ ...tile, pixels: copy(tile, width, height) }));
    const passes = samples > 1 && !heat ? 2 : 1;
    answer("tiles", {
        picture: job.picture,
        tiles: sent,
        progress: more ? Math.min(0.999, job.drawn / (width * height * passes)) : 1,
        rays: engine.rays(),
        nodes: engine.nodes(),
        spent: job.spent,
        fineness: engine.fineness(),
        pictureTime: job.pictureTime,
    }, sent.map(({ pixels }) => pixels.buffer));
    if (more) {
        waiting = true;
        again.port2.postMessage(null);
    } else {
        job = null;
    }
}

function copy({ x, y, width, height }, rowPixels, rows) {
    const all = new Uint8ClampedArray(engine.memory.buffer, engine.pixels(), rowPixels * rows * 4);
    const pixels = new Uint8ClampedArray(width * height * 4);
    for (let row = 0; row < height; row += 1) {
        const from = ((y + row) * rowPixels + x) * 4;
        pixels.set(all.subarray(from, from + width * 4), row * width * 4);
    }
    return pixels;
}

const requests = { open, draw, module: ({ module }) => arrived(module) };
onmessage = ({ data }) => requests[data.kind](data);
