// The page that Chromium opens: renders a scene by vtk.js and gives the bytes of its canvas, bottom row first.
import '@kitware/vtk.js/Rendering/Profiles/Volume';
import vtkColorTransferFunction from '@kitware/vtk.js/Rendering/Core/ColorTransferFunction';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkImageData from '@kitware/vtk.js/Common/DataModel/ImageData';
import vtkLight from '@kitware/vtk.js/Rendering/Core/Light';
import vtkOpenGLRenderWindow from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow';
import vtkPiecewiseFunction from '@kitware/vtk.js/Common/DataModel/PiecewiseFunction';
import vtkPlane from '@kitware/vtk.js/Common/DataModel/Plane';
import vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer';
import vtkRenderWindow from '@kitware/vtk.js/Rendering/Core/RenderWindow';
import vtkRenderWindowInteractor from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor';
import vtkVolume from '@kitware/vtk.js/Rendering/Core/Volume';
import vtkVolumeMapper from '@kitware/vtk.js/Rendering/Core/VolumeMapper';

// vtk.js ends a volume half a voxel beyond its outermost voxels' centres; planes end it there.
function cutAtCentres(mapper, scene) {
  [0, 1, 2].forEach((axis) => {
    const normal = [0, 1, 2].map((i) => (i === axis ? 1 : 0));
    const far = normal.map((x, i) => x * (scene.sizes[i] - 1) * scene.spacing[i]);
    mapper.addClippingPlane(vtkPlane.newInstance({ origin: [0, 0, 0], normal }));
    mapper.addClippingPlane(vtkPlane.newInstance({ origin: far, normal: normal.map((x) => -x) }));
  });
}

function volumeOf(scene) {
  const image = vtkImageData.newInstance();
  image.setDimensions(...scene.sizes);
  image.setSpacing(...scene.spacing);
  image.getPointData().setScalars(vtkDataArray.newInstance({ values: Float32Array.from(scene.values), numberOfComponents: 1, name: 's' }));
  const mapper = vtkVolumeMapper.newInstance();
  mapper.setInputData(image);
  mapper.setAutoAdjustSampleDistances(false);
  mapper.setSampleDistance(scene.step);
  mapper.setMaximumSamplesPerRay(100000);
  if (scene.border === 'voxel_centres') cutAtCentres(mapper, scene);
  const volume = vtkVolume.newInstance();
  volume.setMapper(mapper);
  const color = vtkColorTransferFunction.newInstance();
  const opacity = vtkPiecewiseFunction.newInstance();
  color.setAllowDuplicateScalars?.(true);
  opacity.setAllowDuplicateScalars?.(true);
  for (const [s, rgb] of scene.colors) color.addRGBPoint(s, ...rgb);
  for (const [s, value] of scene.opacities) opacity.addPoint(s, value);
  const property = volume.getProperty();
  property.setRGBTransferFunction(0, color);
  property.setScalarOpacity(0, opacity);
  property.setScalarOpacityUnitDistance(0, scene.unit);
  property.setInterpolationTypeToLinear();
  property.setShade(!!scene.shading);
  if (scene.shading) {
    property.setAmbient(scene.shading.ambient);
    property.setDiffuse(scene.shading.diffuse);
    property.setSpecular(scene.shading.specular);
    property.setSpecularPower(scene.shading.shininess);
  }
  return volume;
}

function lightUp(renderer, shading) {
  renderer.removeAllLights();
  renderer.setAutomaticLightCreation(false);
  const light = vtkLight.newInstance();
  light.setLightTypeToSceneLight();
  light.setPositional(false);
  light.setPosition(...shading.light);
  light.setFocalPoint(0, 0, 0);
  renderer.addLight(light);
}

function aim(camera, given) {
  camera.setPosition(...given.eye);
  camera.setFocalPoint(...given.target);
  camera.setViewUp(...given.up);
  camera.setParallelProjection(true);
  camera.setParallelScale(given.height / 2);
}

window.renderScene = async (scene) => {
  const renderer = vtkRenderer.newInstance();
  if (scene.shading) lightUp(renderer, scene.shading);
  renderer.setBackground(0, 0, 0, 0);
  renderer.addVolume(volumeOf(scene));
  aim(renderer.getActiveCamera(), scene.camera);
  renderer.resetCameraClippingRange();
  const renderWindow = vtkRenderWindow.newInstance();
  renderWindow.addRenderer(renderer);
  const view = vtkOpenGLRenderWindow.newInstance();
  const container = document.createElement('div');
  document.body.appendChild(container);
  view.setContainer(container);
  view.setSize(...scene.camera.size);
  renderWindow.addView(view);
  const interactor = vtkRenderWindowInteractor.newInstance();  // without one the mapper fails, off-screen too
  interactor.setView(view);
  interactor.initialize();
  renderWindow.render();
  renderWindow.render();
  const [width, height] = scene.camera.size;
  const gl = view.get3DContext();
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  return Array.from(pixels);
};
