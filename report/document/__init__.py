"""An analysis in, out comes the JSON document, which is a contract."""
