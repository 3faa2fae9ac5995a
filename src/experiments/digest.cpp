#include "experiments/digest.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace raytruth {

namespace {

void need(int done) {
  if (done != 1) throw std::runtime_error("libcrypto computes no SHA-256");
}

/// A digest that grows with the bytes it is given.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    need(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
  }

  void add(std::string_view bytes) { need(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size())); }

  [[nodiscard]] std::string digits() const {
    std::array<unsigned char, 32> bytes{};
    need(EVP_DigestFinal_ex(context_.get(), bytes.data(), nullptr));
    std::string text;
    for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256(std::string_view text) {
  Sha256 digest;
  digest.add(text);
  return digest.digits();
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Sha256 digest;
  std::array<char, std::size_t{1} << 16U> piece{};
  while (stream.read(piece.data(), piece.size()) || stream.gcount() > 0)
    digest.add({piece.data(), static_cast<std::size_t>(stream.gcount())});
  if (!stream.eof()) throw InputError(fmt::format("{}: cannot be read", file.string()));
  return digest.digits();
}

}  // namespace raytruth
