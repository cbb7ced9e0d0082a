// Canvas of the view.

/**
 * Canvas with its context, which is missing where the browser has no WebGL. Without a graphics card smooth edges and
 * fine pixels take longer than a frame.
 */
export function canvasOf() {
  const made = (antialias) => {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2", { alpha: true, stencil: false, antialias });
    return { canvas, context: context ?? undefined };
  };
  const smooth = made(true);
  if (!smooth.context) {
    return { ...smooth, software: true };
  }
  const about = smooth.context.getExtension("WEBGL_debug_renderer_info");
  const name = about ? smooth.context.getParameter(about.UNMASKED_RENDERER_WEBGL) : "";
  if (!/swiftshader|llvmpipe|software|basic render/i.test(name)) {
    return { ...smooth, software: false };
  }
  smooth.context.getExtension("WEBGL_lose_context")?.loseContext();
  return { ...made(false), software: true };
}

/** Stands in for the renderer without WebGL: nothing is drawn, but all places are known, as for a picture of lines. */
export const NO_RENDERER = {
  setPixelRatio() {},
  setSize() {},
  render(scene, camera) {
    scene.updateMatrixWorld();
    camera.updateMatrixWorld();
  },
};
