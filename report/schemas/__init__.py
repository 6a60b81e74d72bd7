"""The JSON documents as types, with what each field means: ``docs/*.schema.json`` are written from them."""
