// Worker of run.js: program.js stands before this text. The first message has the module and the files, each other one
// a command line.

let program = null;

onmessage = async ({ data }) => {
  if (data.wasm) {
    program = loadProgram(data.wasm, data.files);
    return;
  }
  try {
    const running = await program;
    const found = await running.run(data.words);
    if (data.to !== undefined) {
      const bytes = new TextEncoder().encode(found.stdout);
      running.files.write(data.to, bytes);
      found.written[data.to] = bytes;
      found.stdout = "";
    }
    postMessage(found);
  } catch (error) {
    postMessage({ error: error.message });
  }
};
