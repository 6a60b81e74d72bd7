// name: labels-of-element
// kind: table
// description: What do labels say of one element, on which line, and which word counts more?
// param element: element, name of a node, topic, service, action or other element
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns kind: string, kind of the element
// returns tier: integer, 2 if added in the database, 1 if in your own files, less if it came with the program
// returns specificity: integer, the more of the name is spelt out, the higher; counts among labels of one tier
// returns says: string, source, leak, sanitizer, conduit, derives, mundane, sensitive, only, only: by-type, never, source: none or leak: none
// returns category: string, of which kind of data; every if the label names none
// returns detail: string, method of a sanitizer, channels of a source, what a derivation is made of
// returns label: string, file:line of the label
// order: robot, kind, tier DESC, specificity DESC, says, category, detail, label
MATCH (e:Element {name: $element})-[l:SOURCE_OF|LEAKS|SANITIZES|PASSES|DERIVES|NEVER_HAS|MAY_HAVE|HAS_ONLY|HAS_NOT
                                  |HAS_BY_TYPE|NO_SOURCE_OF|LEAKS_NOT]->(c:DataCategory)
WHERE $robot = '' OR e.robot = $robot
RETURN DISTINCT e.robot AS robot, e.kind AS kind, coalesce(l.tier, 2) AS tier,
       coalesce(l.specificity, 1000000) AS specificity,
       CASE type(l) WHEN 'SOURCE_OF' THEN 'source' WHEN 'LEAKS' THEN 'leak' WHEN 'SANITIZES' THEN 'sanitizer'
            WHEN 'PASSES' THEN 'conduit' WHEN 'DERIVES' THEN 'derives' WHEN 'NEVER_HAS' THEN 'mundane'
            WHEN 'MAY_HAVE' THEN 'sensitive' WHEN 'HAS_ONLY' THEN 'only' WHEN 'HAS_BY_TYPE' THEN 'only: by-type'
            WHEN 'NO_SOURCE_OF' THEN 'source: none' WHEN 'LEAKS_NOT' THEN 'leak: none' ELSE 'never' END AS says,
       CASE WHEN l.every THEN 'every' ELSE c.name END AS category,
       CASE type(l) WHEN 'SANITIZES' THEN coalesce(l.method, 'pseudonymise')
                         + CASE WHEN coalesce(l.stated, l.method IS NOT NULL) THEN '' ELSE ', not stated' END
            WHEN 'DERIVES' THEN 'of ' + l.of
            WHEN 'SOURCE_OF' THEN reduce(text = '', n IN coalesce(l.through, [])
                                         | text + CASE text WHEN '' THEN 'through ' ELSE ', ' END + n)
            ELSE '' END AS detail,
       coalesce(l.file + ':' + l.line, 'by hand') AS label
ORDER BY robot, kind, tier DESC, specificity DESC, says, category, detail, label
