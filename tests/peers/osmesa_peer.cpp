#include "tests/peers/osmesa_peer.hpp"

#include <GL/osmesa.h>
#include <stdlib.h>

namespace limn::peers {

namespace {

// The lights of modeler/view/raster/shading.cpp; colours go out as they are, not as sRGB.
constexpr const char* kVertexShader = R"(#version 120
attribute vec3 place;
attribute vec3 normal;
uniform mat4 matrix;
varying vec3 n;
void main() {
  n = normal;
  gl_Position = matrix * vec4(place, 1.0);
})";
constexpr const char* kFragmentShader = R"(#version 120
varying vec3 n;
const vec3 key = vec3(-0.451, 0.621, 0.641);
const vec3 fill = vec3(0.823, -0.051, 0.566);
float soft(float c) { float part = 0.5 + 0.5 * c; return part * part; }
void main() {
  vec3 m = normalize(n);
  vec3 base = vec3(0.21, 0.35, 0.57);
  if (!gl_FrontFacing) { m = -m; base = vec3(0.63, 0.38, 0.12); }
  float light = 0.09 + 0.15 * (0.5 + 0.5 * m.y) + 0.7 * soft(dot(m, key)) +
                0.14 * soft(dot(m, fill));
  vec3 between = normalize(key + vec3(0.0, 0.0, 1.0));
  float shine = 0.2 * pow(max(dot(m, between), 0.0), 32.0);
  gl_FragColor = vec4(light * base + shine, 1.0);
})";

template <class Function>
Function function_of(const char* name) {
  return reinterpret_cast<Function>(OSMesaGetProcAddress(name));
}

}  // namespace

struct OsmesaRenderer::State {
  OSMesaContext context = nullptr;
  std::vector<std::uint32_t> pixels;
  std::string complaint;
  GLsizei corners = 0;
  GLint matrix = -1;
  PFNGLUNIFORMMATRIX4FVPROC set_matrix = nullptr;

  GLuint compiled(GLenum kind, const char* text) {
    const auto make = function_of<PFNGLCREATESHADERPROC>("glCreateShader");
    const auto source = function_of<PFNGLSHADERSOURCEPROC>("glShaderSource");
    const auto compile = function_of<PFNGLCOMPILESHADERPROC>("glCompileShader");
    const auto status = function_of<PFNGLGETSHADERIVPROC>("glGetShaderiv");
    const GLuint shader = make(kind);
    source(shader, 1, &text, nullptr);
    compile(shader);
    GLint is_compiled = 0;
    status(shader, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled == 0) complaint = "Mesa does not compile a shader";
    return shader;
  }

  GLuint linked_program() {
    const auto make = function_of<PFNGLCREATEPROGRAMPROC>("glCreateProgram");
    const auto attach = function_of<PFNGLATTACHSHADERPROC>("glAttachShader");
    const auto name = function_of<PFNGLBINDATTRIBLOCATIONPROC>("glBindAttribLocation");
    const auto link = function_of<PFNGLLINKPROGRAMPROC>("glLinkProgram");
    const auto use = function_of<PFNGLUSEPROGRAMPROC>("glUseProgram");
    const auto uniform = function_of<PFNGLGETUNIFORMLOCATIONPROC>("glGetUniformLocation");
    const GLuint program = make();
    attach(program, compiled(GL_VERTEX_SHADER, kVertexShader));
    attach(program, compiled(GL_FRAGMENT_SHADER, kFragmentShader));
    name(program, 0, "place");
    name(program, 1, "normal");
    link(program);
    use(program);
    matrix = uniform(program, "matrix");
    if (matrix < 0) complaint = "Mesa does not link the shaders";
    return program;
  }

  void load(const PeerDrawing& mesh) {
    const auto make = function_of<PFNGLGENBUFFERSPROC>("glGenBuffers");
    const auto bind = function_of<PFNGLBINDBUFFERPROC>("glBindBuffer");
    const auto fill = function_of<PFNGLBUFFERDATAPROC>("glBufferData");
    const auto point = function_of<PFNGLVERTEXATTRIBPOINTERPROC>("glVertexAttribPointer");
    const auto enable = function_of<PFNGLENABLEVERTEXATTRIBARRAYPROC>("glEnableVertexAttribArray");
    GLuint buffers[3];
    make(3, buffers);
    const std::vector<float>* const attributes[] = {&mesh.places, &mesh.normals};
    for (GLuint i = 0; i < 2; ++i) {
      bind(GL_ARRAY_BUFFER, buffers[i]);
      fill(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(attributes[i]->size() * sizeof(float)),
           attributes[i]->data(), GL_STATIC_DRAW);
      point(i, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
      enable(i);
    }
    bind(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
    fill(GL_ELEMENT_ARRAY_BUFFER,
         static_cast<GLsizeiptr>(mesh.corners.size() * sizeof(std::uint32_t)), mesh.corners.data(),
         GL_STATIC_DRAW);
    corners = static_cast<GLsizei>(mesh.corners.size());
  }
};

OsmesaRenderer::OsmesaRenderer(const PeerDrawing& mesh, int width, int height)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  // No threads of its own: the processor time of this one is all that it takes.
  setenv("LP_NUM_THREADS", "0", 1);
  s.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  s.context = OSMesaCreateContextExt(OSMESA_BGRA, 24, 0, 0, nullptr);
  if (s.context == nullptr ||
      OSMesaMakeCurrent(s.context, s.pixels.data(), GL_UNSIGNED_BYTE, width, height) == 0) {
    s.complaint = "Mesa makes no context";
    return;
  }
  s.linked_program();
  s.load(mesh);
  s.set_matrix = function_of<PFNGLUNIFORMMATRIX4FVPROC>("glUniformMatrix4fv");
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glClearColor(0.9F, 0.92F, 0.94F, 1);
  if (glGetError() != GL_NO_ERROR) s.complaint = "Mesa reports an error";
}

OsmesaRenderer::~OsmesaRenderer() {
  if (state_->context != nullptr) OSMesaDestroyContext(state_->context);
}

const std::string& OsmesaRenderer::complaint() const { return state_->complaint; }

std::string OsmesaRenderer::name() const {
  return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

void OsmesaRenderer::draw(const std::array<float, 16>& matrix) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  state_->set_matrix(state_->matrix, 1, GL_FALSE, matrix.data());
  glDrawElements(GL_TRIANGLES, state_->corners, GL_UNSIGNED_INT, nullptr);
  glFinish();
}

const std::vector<std::uint32_t>& OsmesaRenderer::pixels() const { return state_->pixels; }

}  // namespace limn::peers
