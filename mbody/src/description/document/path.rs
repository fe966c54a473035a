//! Dotted paths for people, JSON pointers (RFC 6901) for the machine.

use serde_json::Value;

/// Whether a path may leave out the tags of kinds.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Tags {
    Exact,
    Skipped,
}

/// The pointer one step further.
pub(super) fn step(pointer: &str, key: &str) -> String {
    format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1"))
}

pub(super) fn unescaped(step: &str) -> String {
    step.replace("~1", "/").replace("~0", "~")
}

/// `elements.shock` of `/elements/shock`.
pub(super) fn dotted(pointer: &str) -> String {
    pointer.split('/').skip(1).map(unescaped).collect::<Vec<_>>().join(".")
}

/// What is around an entry, and its name.
pub(super) fn split(pointer: &str) -> Option<(&str, String)> {
    let (around, name) = pointer.rsplit_once('/')?;
    Some((around, unescaped(name)))
}

/// Tag and entries of a value like `{ spring_damper: { … } }`.
pub(super) fn tag(value: &Value) -> Option<(&str, &Value)> {
    let entries = value.as_object().filter(|entries| entries.len() == 1)?;
    entries.iter().next().filter(|(_, inner)| inner.is_object()).map(|(tag, inner)| (tag.as_str(), inner))
}

/// Pointer, from `value` on, to the entry of a dotted path. Names may contain points: the longest fitting name comes first.
pub(super) fn find(value: &Value, path: &str, tags: Tags) -> Option<String> {
    if path.is_empty() {
        return Some(String::new());
    }
    let rest_after = |name: &str| match path.strip_prefix(name)? {
        "" => Some(""),
        rest => rest.strip_prefix('.').filter(|rest| !rest.is_empty()),
    };
    match value {
        Value::Object(entries) => {
            let mut fitting: Vec<(&String, &Value, &str)> =
                entries.iter().filter_map(|(name, inner)| Some((name, inner, rest_after(name)?))).filter(|f| !f.0.is_empty()).collect();
            fitting.sort_by_key(|(name, ..)| std::cmp::Reverse(name.len()));
            let exact = fitting.into_iter().find_map(|(name, inner, rest)| Some(step("", name) + &find(inner, rest, tags)?));
            exact.or_else(|| {
                let (tag, inner) = tag(value).filter(|_| tags == Tags::Skipped)?;
                Some(step("", tag) + &find(inner, path, tags)?)
            })
        }
        Value::Array(items) => {
            let (number, rest) = path.split_once('.').unwrap_or((path, ""));
            let item = items.get(number.parse::<usize>().ok()?)?;
            Some(step("", number) + &find(item, rest, tags)?)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn paths_and_pointers_belong_together() {
        let value = json!({"a.b": {"c/d": [1, {"e": 2}]}, "a": {"b": 3}, "s": {"kind": {"k": 1}}});
        let exact = |path| find(&value, path, Tags::Exact);
        assert_eq!(exact("a.b.c/d.1.e").as_deref(), Some("/a.b/c~1d/1/e"));
        assert_eq!(exact("a.b").as_deref(), Some("/a.b"));
        assert_eq!(exact("a.b.").as_deref(), None);
        assert_eq!(exact("s.k"), None);
        assert_eq!(find(&value, "s.k", Tags::Skipped).as_deref(), Some("/s/kind/k"));
        assert_eq!(dotted("/a.b/c~1d/1/e"), "a.b.c/d.1.e");
        assert_eq!(split("/a/c~1d"), Some(("/a", "c/d".to_string())));
    }
}
