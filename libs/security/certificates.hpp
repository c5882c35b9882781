// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palpate::security {

/// Seconds since 1970.
struct Period {
  std::int64_t begin_s = 0;
  std::int64_t end_s = 0;
};

/// A certificate and its private key, both in PEM format. Keys are of the curve P-256.
struct Credentials {
  std::string certificate_pem;
  std::string private_key_pem;
};

struct CertificateFacts {
  std::string common_name;
  std::string serial_hex;
  Period valid;
};

/// What an authority's certificate may be used for.
enum class AuthorityUse {
  kIdentities,  ///< signs certificates and revocation lists
  kDocuments,   ///< signs documents; certificates that it signs are refused
};

/// A self-signed certificate. Throws RunError where OpenSSL fails; so do all that make something.
Credentials CreateAuthority(const std::string& common_name, AuthorityUse use, const Period& valid);

/// A certificate for `common_name`, signed by `authority`, with a random serial number.
Credentials IssueIdentity(const Credentials& authority, const std::string& common_name,
                          const Period& valid);

/// The certificates of `authority` that are revoked, in PEM format. `number` rises with each list.
std::string MakeRevocationList(const Credentials& authority,
                               const std::vector<std::string>& serials_hex, int number,
                               const Period& valid);

/// Throws InputError ("is no certificate ...").
CertificateFacts ReadCertificate(const std::string& certificate_pem);

/// End of the period in which a revocation list holds, s since 1970. Throws InputError.
std::int64_t RevocationListEnd_s(const std::string& list_pem);

/// Why a certificate does not hold at the time `now_s`: "" where it does. `revocation_list_pem`:
/// "" for none. Throws InputError where one of the texts is not in PEM format.
std::string Objection(const std::string& certificate_pem, const std::string& authority_pem,
                      const std::string& revocation_list_pem, std::int64_t now_s);

/// Whether the key is that of the certificate. Throws InputError where one is none.
bool KeyFits(const std::string& certificate_pem, const std::string& private_key_pem);

/// Whether both certificates have one key. Throws InputError where one is none.
bool HaveOneKey(const std::string& a_pem, const std::string& b_pem);

}  // namespace palpate::security
