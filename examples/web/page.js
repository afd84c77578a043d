// The page: what is chosen goes to the worker, tiles come back. All drawing and reading of files is the worker's.

const at = (id) => document.getElementById(id);
const canvas = at("picture");
const context = canvas.getContext("2d", { alpha: false });
const HOME = { yaw: 0.14, pitch: 0.42, zoom: 1 };
// A picture of more pixels is stretched by the browser.
const WIDEST = 560;

const camera = { ...HOME };
let source = { builtIn: 0 };
let shown = null; // What is on the screen, should the next model be refused.
let picture = 0;
let worker = null;

function complain(text) {
    at("message").textContent = text;
    at("message").hidden = !text;
}

// ---- To the worker

function open() {
    at("build").textContent = "building …";
    worker.postMessage({
        kind: "open",
        source,
        structure: Number(at("structure").value),
        preset: Number(at("preset").value),
    });
}

function draw() {
    picture += 1;
    const terms = [...document.querySelectorAll("[data-term]")];
    const view = {
        width: canvas.width,
        height: canvas.height,
        ...camera,
        terms: terms.reduce((bits, box) => bits | (box.checked << box.dataset.term), 0),
        bounces: Number(at("bounces").value),
        samples: at("smooth").checked ? 3 : 1,
        heat: at("heat").checked ? 1 : 0,
    };
    canvas.dataset.view = JSON.stringify(view);
    canvas.dataset.state = "drawing";
    worker.postMessage({ kind: "draw", picture, view });
}

// ---- From the worker

const count = (number) => Math.round(number).toLocaleString("en");
const bytes = (number) => (number < 1e4 ? `${number} B` : number < 1e6 ? `${(number / 1e3).toFixed(1)} kB` : `${(number / 1e6).toFixed(2)} MB`);
const time = (ms) => (ms < 1000 ? `${ms.toFixed(ms < 10 ? 1 : 0)} ms` : `${(ms / 1000).toFixed(2)} s`);
let built = "–";

const answers = {
    opened({ source: opened, primitives, structureBytes, buildTime }) {
        complain("");
        shown = opened;
        const option = at("model").querySelector("[value=file]");
        if (opened.name) {
            option.textContent = opened.name;
            option.hidden = option.disabled = false;
        }
        at("model").value = opened.name ? "file" : opened.builtIn;
        at("primitives").textContent = count(primitives);
        at("bytes").textContent = bytes(structureBytes);
        at("each").textContent = (structureBytes / primitives).toFixed(1);
        built = time(buildTime);
        at("build").textContent = built;
        draw();
    },

    refused({ text }) {
        complain(text);
        at("build").textContent = built;
        source = shown ?? source;
        at("model").value = source.name ? "file" : source.builtIn;
        at("file").value = "";
        canvas.dataset.refused = text;
    },

    tiles({ picture: of, tiles, progress, rays, nodes, spent, fineness, pictureTime }) {
        if (of !== picture) {
            return;
        }
        for (const { x, y, width, height, pixels } of tiles) {
            context.putImageData(new ImageData(pixels, width, height), x, y);
        }
        if (tiles.length) {
            mark("first tile");
        }
        at("progress").value = progress;
        at("rays").textContent = count(rays);
        at("speed").textContent = spent > 0 ? (rays / spent / 1000).toFixed(2) : "–";
        at("nodes").textContent = (nodes / rays).toFixed(1);
        at("legend").hidden = !at("heat").checked;
        if (pictureTime) {
            at("time").textContent = time(pictureTime);
            mark("first picture");
        }
        canvas.dataset.fineness = fineness;
        if (progress === 1) {
            canvas.dataset.state = "done";
        }
    },
};

function mark(name) {
    if (!performance.getEntriesByName(name).length) {
        performance.mark(name);
    }
}

// ---- Settings

at("model").addEventListener("change", ({ target }) => {
    source = target.value === "file" ? shown : { builtIn: Number(target.value) };
    Object.assign(camera, HOME);
    open();
});
for (const id of ["structure", "preset"]) {
    at(id).addEventListener("change", open);
}
for (const input of document.querySelectorAll("[data-term], #smooth, #heat")) {
    input.addEventListener("change", draw);
}
at("bounces").addEventListener("input", ({ target }) => {
    at("bounces-shown").value = target.value;
    draw();
});
at("settings").addEventListener("submit", (event) => event.preventDefault());

function take(file) {
    if (file) {
        source = { name: file.name, file };
        Object.assign(camera, HOME);
        open();
    }
}
at("file").addEventListener("change", ({ target }) => take(target.files[0]));
for (const kind of ["dragover", "dragleave", "drop"]) {
    document.addEventListener(kind, (event) => {
        event.preventDefault();
        document.body.classList.toggle("dropping", kind === "dragover");
        take(event.dataTransfer?.files[0]);
    });
}

// ---- The camera: one finger, mouse or arrow keys turn; two fingers, wheel, plus and minus zoom.

let asked = false;
function turn(right, up, nearer = 1) {
    camera.yaw -= right;
    camera.pitch = Math.min(1.5, Math.max(-1.5, camera.pitch + up));
    camera.zoom = Math.min(20, Math.max(0.2, camera.zoom * nearer));
    if (!asked) {
        asked = true;
        requestAnimationFrame(() => {
            asked = false;
            draw();
        });
    }
}

const fingers = new Map();
const apart = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
};
canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
});
canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) {
        return;
    }
    const before = fingers.size === 2 ? apart() : 0;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (before > 0) {
        turn(0, 0, apart() / before);
    } else {
        const whole = canvas.clientHeight / Math.PI;
        turn((event.clientX - last.x) / whole, (event.clientY - last.y) / whole);
    }
});
for (const kind of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
}
canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    turn(0, 0, Math.exp(-Math.sign(event.deltaY) * 0.1));
}, { passive: false });

const KEYS = {
    ArrowLeft: [-0.1, 0],
    ArrowRight: [0.1, 0],
    ArrowUp: [0, 0.1],
    ArrowDown: [0, -0.1],
    "+": [0, 0, 1.1],
    "=": [0, 0, 1.1],
    "-": [0, 0, 1 / 1.1],
};
canvas.addEventListener("keydown", (event) => {
    if (event.key === "Home") {
        Object.assign(camera, HOME);
        turn(0, 0);
    } else if (KEYS[event.key] && !event.ctrlKey && !event.metaKey) {
        turn(...KEYS[event.key]);
    } else {
        return;
    }
    event.preventDefault();
});

// ---- Begin

/** Fetches and compiles the engine, while the worker starts. */
async function compile() {
    const response = await fetch("hitscan.wasm");
    if (!response.ok) {
        throw new Error(`hitscan.wasm: ${response.status}. Build it first: examples/web/build`);
    }
    // Some servers of files do not know the type.
    return response.headers.get("Content-Type") === "application/wasm"
        ? WebAssembly.compileStreaming(response)
        : WebAssembly.compile(await response.arrayBuffer());
}

if (typeof WebAssembly !== "object" || typeof Worker !== "function") {
    complain("This browser has no WebAssembly or no workers, which the engine needs. Any browser since 2018 has both.");
} else {
    worker = new Worker("worker.js", { type: "module" });
    worker.addEventListener("message", ({ data }) => answers[data.kind](data));
    worker.addEventListener("error", (event) => complain(`The engine stopped: ${event.message ?? "it could not be loaded"}. Reload the page.`));
    open();
    compile().then(
        (module) => worker.postMessage({ kind: "module", module }),
        (error) => complain(`The engine could not be loaded. ${error.message}`),
    );
    const scale = Math.min(WIDEST, Math.round(canvas.clientWidth * devicePixelRatio)) / 4;
    canvas.width = Math.max(1, Math.floor(scale)) * 4;
    canvas.height = canvas.width / 4 * 3;
}
