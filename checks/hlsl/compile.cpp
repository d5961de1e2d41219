// Microsoft's compilers of HLSL, as DLLs beside this program: DXC for Shader Model 6, FXC for 5. A Windows program, which
// Wine runs: `./dev hlsl`.
//
//     compile.exe < LIST     a line for each shader: PROFILE FILE, such as `ps_6_0 shader.hlsl`
//
// Prints what is wrong; exit status 1 when something is. Of DXC a warning is wrong, too.
#include <windows.h>

#include <d3dcompiler.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

namespace {

// Of dxcapi.h, which MinGW has not: the methods in their order.

struct DxcBuffer {
  const void* text;
  SIZE_T size;
  UINT32 encoding;
};

struct DxcBlob : IUnknown {
  virtual void* STDMETHODCALLTYPE GetBufferPointer() = 0;
  virtual SIZE_T STDMETHODCALLTYPE GetBufferSize() = 0;
};

struct DxcResult : IUnknown {
  virtual HRESULT STDMETHODCALLTYPE GetStatus(HRESULT* status) = 0;
  virtual HRESULT STDMETHODCALLTYPE GetResult(DxcBlob** result) = 0;
  virtual HRESULT STDMETHODCALLTYPE GetErrorBuffer(DxcBlob** errors) = 0;
};

struct DxcCompiler : IUnknown {
  virtual HRESULT STDMETHODCALLTYPE Compile(const DxcBuffer* source, const wchar_t** words, UINT32 count,
                                            void* includes, REFIID wanted, void** result) = 0;
};

constexpr GUID kCompiler = {0x73e22d93, 0xe6ce, 0x47f3, {0xb5, 0xbf, 0xf0, 0x66, 0x4f, 0x39, 0xc1, 0xb0}};
constexpr GUID kCompiler3 = {0x228b4687, 0x5a6a, 0x4730, {0x90, 0x0c, 0x97, 0x02, 0xb2, 0x20, 0x3f, 0x54}};
constexpr GUID kResult = {0xcedb484a, 0xd4e9, 0x445a, {0xb9, 0x91, 0xca, 0x21, 0xca, 0x15, 0x7d, 0xc2}};
constexpr UINT32 kUtf8 = 65001;

template <class Function>
Function functionOf(const char* library, const char* name) {
  const HMODULE module = LoadLibraryA(library);
  const FARPROC found = module == nullptr ? nullptr : GetProcAddress(module, name);
  if (found == nullptr) {
    std::cerr << library << " has no " << name << '\n';
    ExitProcess(2);
  }
  return reinterpret_cast<Function>(reinterpret_cast<void*>(found));
}

bool compiledByDxc(const std::string& profile, const std::string& file, const std::string& text) {
  using Create = HRESULT(WINAPI*)(REFCLSID, REFIID, void**);
  static const auto create = functionOf<Create>("dxcompiler.dll", "DxcCreateInstance");
  static DxcCompiler* const compiler = [] {
    DxcCompiler* made = nullptr;
    if (FAILED(create(kCompiler, kCompiler3, reinterpret_cast<void**>(&made)))) {
      std::cerr << "dxcompiler.dll makes no compiler\n";
      ExitProcess(2);
    }
    return made;
  }();
  const std::wstring name(file.begin(), file.end()), model(profile.begin(), profile.end());
  std::vector<const wchar_t*> words = {name.c_str(), L"-T", model.c_str(), L"-E", L"main", L"-WX"};
  if (text.find("#define LACQUER_ROOT_SIGNATURE ") != std::string::npos)
    words.insert(words.end(), {L"-rootsig-define", L"LACQUER_ROOT_SIGNATURE"});
  const DxcBuffer source{text.data(), text.size(), kUtf8};
  DxcResult* result = nullptr;
  HRESULT status = compiler->Compile(&source, words.data(), static_cast<UINT32>(words.size()), nullptr, kResult,
                                     reinterpret_cast<void**>(&result));
  if (FAILED(status)) return false;
  DxcBlob* errors = nullptr;
  if (SUCCEEDED(result->GetErrorBuffer(&errors)) && errors != nullptr) {
    std::cerr << std::string(static_cast<const char*>(errors->GetBufferPointer()), errors->GetBufferSize()).c_str();
    errors->Release();
  }
  result->GetStatus(&status);
  result->Release();
  return SUCCEEDED(status);
}

bool compiledByFxc(const std::string& profile, const std::string& file, const std::string& text) {
  static const auto compile = functionOf<decltype(&D3DCompile)>("d3dcompiler_47.dll", "D3DCompile");
  const bool spaces = profile.ends_with("_1");
  const D3D_SHADER_MACRO macros[] = {{spaces ? "LACQUER_SPACES" : nullptr, "1"}, {nullptr, nullptr}};
  constexpr UINT kUnboundedTables = 1U << 20U;
  ID3DBlob *code = nullptr, *errors = nullptr;
  const HRESULT status = compile(text.data(), text.size(), file.c_str(), macros, nullptr, "main", profile.c_str(),
                                 spaces ? kUnboundedTables : 0, 0, &code, &errors);
  if (FAILED(status) && errors != nullptr) std::cerr << static_cast<const char*>(errors->GetBufferPointer());
  if (errors != nullptr) errors->Release();
  if (code != nullptr) code->Release();
  return SUCCEEDED(status);
}

}  // namespace

int main() {
  int count = 0, wrong = 0;
  for (std::string profile, file; std::cin >> profile >> file; ++count) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const bool dxc = profile.find("_6_") != std::string::npos;
    const bool good = in && (dxc ? compiledByDxc(profile, file, text) : compiledByFxc(profile, file, text));
    if (good) continue;
    std::cerr << profile << ' ' << file << ": FAILED\n";
    ++wrong;
  }
  std::cout << count << " compiled, " << wrong << " wrong\n";
  return wrong == 0 && count > 0 ? 0 : 1;
}
