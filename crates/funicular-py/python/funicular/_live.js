// The page of a robot in a notebook cell: shows it in a frame, and gives every change of its state to Python.

function render({ model, el }) {
  const frame = document.createElement("iframe");
  frame.title = "Robot of funicular";
  frame.style.cssText = "width: 100%; height: 820px; border: 0";
  el.append(frame);

  // Python sends the page when it is asked, so that the notebook does not save it.
  const receive = (content) => {
    if (content?.page && !frame.srcdoc) {
      frame.srcdoc = content.page;
    }
  };
  const told = (event) => {
    const { source, data } = event;
    if (source !== frame.contentWindow || !data?.funicular) {
      return;
    }
    if (data.funicular === "ready") {
      source.postMessage({ funicular: "listen", state: model.get("state") }, "*");
    } else {
      model.set("state", data.funicular);
      model.save_changes();
    }
  };
  model.on("msg:custom", receive);
  addEventListener("message", told);
  model.send({ ask: "page" });

  return () => {
    model.off("msg:custom", receive);
    removeEventListener("message", told);
  };
}

export default { render };
