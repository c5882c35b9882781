// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/security/material.hpp"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/core/utc_text.hpp"
#include "libs/security/certificates.hpp"
#include "libs/security/signed_document.hpp"

namespace palpate::security {

namespace {

using Path = std::filesystem::path;

constexpr mode_t kOfOthers = S_IRWXG | S_IRWXO;

/// Checks one identity and collects what is wrong.
class MaterialCheck {
 public:
  MaterialCheck(const Material& material, std::int64_t now_s)
      : material_(material),
        now_s_(now_s),
        reissue_("palpate security enroll KEYSTORE " + material.name +
                 ", then copy the folder to this host") {}

  std::vector<Finding> Run() {
    if (!IsFolderThere() || !AreFilesThere()) return std::move(findings_);
    CheckKeyMode();
    try {
      CheckIdentity();
      CheckDocuments();
    } catch (const RunError& error) {
      Add(material_.folder, error.what(), reissue_);
    }
    return std::move(findings_);
  }

 private:
  void Add(const Path& file, std::string problem, std::string remedy,
           Severity severity = Severity::kError) {
    findings_.push_back({severity, file, std::move(problem), std::move(remedy)});
  }

  const std::string& TextOf(const Path& file) { return texts_.at(file); }

  bool IsFolderThere() {
    std::error_code error;
    if (std::filesystem::is_directory(material_.folder, error)) return true;
    std::vector<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(material_.folder.parent_path(), error)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    const std::string there = names.empty() ? "" : " (there: " + Listed(names) + ")";
    Add(material_.folder,
        "no identity '" + material_.name + "' here" + DidYouMean(material_.name, names) + there,
        reissue_);
    return false;
  }

  bool AreFilesThere() {
    for (const Path& file :
         {material_.identity_authority, material_.certificate, material_.private_key,
          material_.revocation_list, material_.permissions_authority, material_.governance,
          material_.permissions}) {
      if (file.empty()) continue;
      try {
        texts_[file] = ReadFile(file);
        if (texts_[file].empty()) Add(file, "is empty", reissue_);
      } catch (const InputError& error) {
        std::string problem = error.what();
        problem.erase(0, file.string().size() + 2);  // "FILE: "
        Add(file, problem, "chown it to the user of this process, or " + reissue_);
      }
    }
    return findings_.empty();
  }

  void CheckKeyMode() {
    struct stat status {};
    if (stat(material_.private_key.c_str(), &status) != 0) return;
    if ((status.st_mode & kOfOthers) == 0) return;
    Add(material_.private_key,
        fmt::format("other users may read it (mode {:04o})", status.st_mode & 07777U),
        "chmod 600 " + material_.private_key.string());
  }

  void CheckDates(const Path& file, const Period& valid) {
    if (now_s_ < valid.begin_s) {
      Add(file,
          "is not valid before " + UtcText(valid.begin_s) + ", and this host has " +
              UtcText(now_s_),
          "set the clock of this host");
    } else if (now_s_ > valid.end_s) {
      Add(file, "expired at " + UtcText(valid.end_s), reissue_);
    } else if (now_s_ > valid.end_s - kWarnBeforeEnd_s) {
      Add(file, "expires at " + UtcText(valid.end_s), reissue_, Severity::kWarning);
    }
  }

  /// The period of a certificate; nullopt where it is none, which is then a finding.
  std::optional<CertificateFacts> FactsOf(const Path& file) {
    try {
      return ReadCertificate(TextOf(file));
    } catch (const InputError& error) {
      Add(file, error.what(), reissue_);
      return std::nullopt;
    }
  }

  void CheckIdentity() {
    const auto authority = FactsOf(material_.identity_authority);
    const auto own = FactsOf(material_.certificate);
    if (!authority || !own) return;
    CheckDates(material_.identity_authority, authority->valid);
    CheckDates(material_.certificate, own->valid);
    subject_ = own->common_name;
    try {
      if (!KeyFits(TextOf(material_.certificate), TextOf(material_.private_key))) {
        Add(material_.private_key, "is not the key of " + material_.certificate.string(), reissue_);
      }
    } catch (const InputError& error) {
      Add(material_.private_key, error.what(), reissue_);
    }
    CheckChain(own->valid);
  }

  void CheckChain(const Period& valid) {
    const std::string list =
        material_.revocation_list.empty() ? "" : TextOf(material_.revocation_list);
    try {
      if (!list.empty()) CheckDates(material_.revocation_list, {0, RevocationListEnd_s(list)});
      // At a time within the dates, which are checked above.
      const std::int64_t then_s = std::clamp(now_s_, valid.begin_s, valid.end_s);
      const std::string objection = Objection(TextOf(material_.certificate),
                                              TextOf(material_.identity_authority), list, then_s);
      if (objection == "certificate revoked") {
        Add(material_.certificate, "was revoked", reissue_ + " if it may come back");
      } else if (!objection.empty() && findings_.empty()) {
        Add(material_.certificate,
            "does not follow from " + material_.identity_authority.string() + " (" + objection +
                ")",
            reissue_);
      }
    } catch (const InputError& error) {
      Add(material_.revocation_list, error.what(), reissue_);
    }
  }

  void CheckDocuments() {
    const auto authority = FactsOf(material_.permissions_authority);
    if (!authority) return;
    CheckDates(material_.permissions_authority, authority->valid);
    if (HaveOneKey(TextOf(material_.permissions_authority), TextOf(material_.identity_authority))) {
      Add(material_.permissions_authority,
          "signs identities, too, so that each identity could sign permissions for itself "
          "(CVE-2023-24011)",
          "make two authorities: palpate security init");
    }
    (void)Verified(material_.governance);
    const auto permissions = Verified(material_.permissions);
    if (permissions) CheckPermissions(*permissions);
  }

  std::optional<std::string> Verified(const Path& file) {
    try {
      return VerifiedDocument(TextOf(file), TextOf(material_.permissions_authority));
    } catch (const InputError& error) {
      Add(file, error.what(), reissue_);
      return std::nullopt;
    }
  }

  void CheckPermissions(const std::string& xml) {
    const std::string subject = TagText(xml, "subject_name");
    if (!subject_.empty() && subject != "CN=" + subject_) {
      Add(material_.permissions, "is for '" + Excerpt(subject) + "', not for 'CN=" + subject_ + "'",
          reissue_);
    }
    const std::string end = TagText(xml, "not_after");
    if (!end.empty() && end < UtcText(now_s_)) {
      Add(material_.permissions, "expired at " + Excerpt(end), reissue_);
    }
  }

  const Material& material_;
  std::int64_t now_s_;
  std::string reissue_;
  std::string subject_;
  std::map<Path, std::string> texts_;
  std::vector<Finding> findings_;
};

}  // namespace

std::string Finding::ToString() const { return file.string() + ": " + problem + ": " + remedy; }

Material MaterialOf(const std::filesystem::path& keystore, const std::string& name) {
  const Path folder = keystore / "enclaves" / name;
  const Path list = folder / "crl.pem";
  std::error_code error;
  return {.name = name,
          .folder = folder,
          .identity_authority = folder / "identity_ca.cert.pem",
          .certificate = folder / "cert.pem",
          .private_key = folder / "key.pem",
          .revocation_list = std::filesystem::exists(list, error) ? list : Path(),
          .permissions_authority = folder / "permissions_ca.cert.pem",
          .governance = folder / "governance.p7s",
          .permissions = folder / "permissions.p7s"};
}

std::vector<Finding> CheckMaterial(const Material& material, std::int64_t now_s) {
  return MaterialCheck(material, now_s).Run();
}

Material LoadMaterial(const std::filesystem::path& keystore, const std::string& name,
                      std::int64_t now_s) {
  Material material = MaterialOf(std::filesystem::absolute(keystore), name);
  for (const Finding& finding : CheckMaterial(material, now_s)) {
    if (finding.severity == Severity::kError) throw InputError(finding.ToString());
  }
  return material;
}

std::string TagText(const std::string& xml, const std::string& tag) {
  const std::string open = "<" + tag + ">";
  const std::size_t begin = xml.find(open);
  if (begin == xml.npos) return {};
  const std::size_t text = begin + open.size();
  const std::size_t end = xml.find("</" + tag + ">", text);
  return end == xml.npos ? "" : xml.substr(text, end - text);
}

}  // namespace palpate::security
